/* Misbehaviour of FMUs, by environment variable: places are those of the shells, "load" and
 * "unload". */
#define _GNU_SOURCE
#include "hostile.h"

#include <fcntl.h>
#include <fenv.h>
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

void throw_exception(void); /* hostile_exception.cpp */

static volatile int zero = 0;

static int recurse(int depth);
static int (*volatile deeper)(int depth) = recurse;
static int recurse(int depth) {
  volatile char space[1024];
  space[0] = (char)depth;
  return deeper(depth + 1) + space[0];
}

static void close_all(void) {
  for (int i = 0; i < 1024; ++i) close(i);
}

static void hang(void) {
  for (;;) pause();
}

/* In the folder for temporary files. */
static void make_file(const char* name) {
  char file[1000];
  snprintf(file, sizeof file, "%s/%s", getenv("TMPDIR"), name);
  close(open(file, O_WRONLY | O_CREAT, 0600));
}

static void ignore_all(void) {
  for (int i = 1; i < NSIG; ++i) signal(i, SIG_IGN);
}

static void act(const char* action, void (*log)(void*, const char*), void* environment) {
  if (!strcmp(action, "exit0")) exit(0);
  if (!strcmp(action, "exit7")) _exit(7);
  if (!strcmp(action, "segv")) *(volatile int*)(long)zero = 1;
  if (!strcmp(action, "abort")) {
    fprintf(stderr, "no licence for this pump\n");
    abort();
  }
  if (!strcmp(action, "log_and_abort")) {
    log(environment, "the licence has run out");
    abort();
  }
  if (!strcmp(action, "divide")) zero = 7 / zero;
  if (!strcmp(action, "kill")) raise(SIGKILL);
  if (!strcmp(action, "stop")) raise(SIGSTOP);
  if (!strcmp(action, "hang")) hang();
  if (!strcmp(action, "say_and_hang")) {
    make_file("hangs");
    hang();
  }
  if (!strcmp(action, "hang_deaf")) {
    ignore_all();
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, NULL);
    hang();
  }
  if (!strcmp(action, "hang_in_handler")) {
    signal(SIGSEGV, (void (*)(int))hang);
    *(volatile int*)(long)zero = 1;
  }
  if (!strcmp(action, "recursion")) zero = recurse(0);
  if (!strcmp(action, "exception")) throw_exception();
  if (!strcmp(action, "close_all")) close_all();
  if (!strcmp(action, "close_and_open")) {
    close_all();
    for (int i = 0; i < 10; ++i) open("/dev/null", O_RDWR);
  }
  if (!strcmp(action, "close_and_pair")) {
    int ends[2];
    close_all();
    for (int i = 0; i < 10; ++i) (void)!socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends);
  }
  if (!strcmp(action, "rubbish"))
    for (int i = 3; i < 10; ++i) (void)!write(i, "rubbish", 7);
  if (!strcmp(action, "kill_supervisor")) {
    kill(getppid(), SIGKILL);
    hang();
  }
  if (!strcmp(action, "kill_group")) kill(0, SIGKILL);
  if (!strcmp(action, "endless_log"))
    for (;;) log(environment, "and another one");
  if (!strcmp(action, "endless_print"))
    for (;;) printf("and another line\n");
  /* After these it goes on. */
  if (!strcmp(action, "trace")) make_file("trace");
  if (!strcmp(action, "close_standard"))
    for (int i = 0; i < 3; ++i) close(i);
  if (!strcmp(action, "chdir")) (void)!chdir("/");
  if (!strcmp(action, "print")) {
    for (int i = 0; i < 20000; ++i) printf("a line of what this FMU prints\n");
    fprintf(stderr, "and an error\n");
    fflush(stdout);
  }
  if (!strcmp(action, "flood")) {
    char text[64];
    for (int i = 0; i < 20000; ++i) {
      snprintf(text, sizeof text, "message %d", i);
      log(environment, text);
    }
  }
  if (!strcmp(action, "long_log")) {
    char* text = malloc(1 << 20);
    memset(text, 'x', 1 << 20);
    text[(1 << 20) - 1] = '\0';
    log(environment, text);
    free(text);
  }
  if (!strcmp(action, "strange_log")) log(environment, "a\033[31mred\n\xff\xfe bar\xc3\xa9");
  if (!strcmp(action, "numbers")) {
    setlocale(LC_ALL, "");
    setenv("LC_ALL", "de_DE.UTF-8", 1);
    fesetround(FE_UPWARD);
    umask(0777);
  }
  if (!strcmp(action, "limits")) {
    const struct rlimit none = {0, 0}, few = {16, 16};
    setrlimit(RLIMIT_FSIZE, &none);
    setrlimit(RLIMIT_NOFILE, &few);
    setrlimit(RLIMIT_NPROC, &none);
  }
  if (!strcmp(action, "handlers")) ignore_all();
  if (!strcmp(action, "fork")) (void)!fork(); /* both come back */
  if (!strcmp(action, "daemon") && fork() == 0) {
    setsid();
    ignore_all();
    if (fork() != 0) _exit(0);
    hang();
  }
  if (!strcmp(action, "lock_folder")) {
    const char* folder = getenv("TMPDIR");
    char command[1000];
    snprintf(command, sizeof command,
             "cd %s/bentaxis-fmu-*/ && mkdir -p resources/a/b && touch resources/a/b/c && chmod 0 "
             "resources/a/b && "
             "chmod 0 resources/a && ln -s / resources/root && chmod 0500 resources",
             folder != NULL ? folder : "/tmp");
    (void)!system(command);
  }
}

void misbehave(const char* place, void (*log)(void*, const char*), void* environment) {
  const char* wanted = getenv("BENTAXIS_TEST_HOSTILE");
  const size_t length = strlen(place);
  if (wanted == NULL || strncmp(wanted, place, length) != 0 || wanted[length] != ' ') return;
  act(wanted + length + 1, log, environment);
}

static void nobody(void* environment, const char* text) {
  (void)environment;
  (void)text;
}
__attribute__((constructor)) static void load(void) { misbehave("load", nobody, NULL); }
__attribute__((destructor)) static void unload(void) { misbehave("unload", nobody, NULL); }
