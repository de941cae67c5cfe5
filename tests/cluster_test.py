#!/usr/bin/python3
"""A sweep on a cluster: docs/sweep.slurm under Slurm, with a controller and two nodes on this machine.

usage: cluster_test.py BENTAXIS REPO_ROOT [options of unittest]

Every test starts its own Slurm in a temporary folder, with its own key, ports and files, as the user that runs it, and
ends it again. Nothing of an installed Slurm is used but its programs. Skipped (exit status 77) where they are not
installed. Whatever cuts a sweep (parts, ranks, nodes, a node that fails), its results must be those of one
process, byte for byte.
"""

import os
import pathlib
import pwd
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77
NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "scontrol", "sinfo")
RESULTS = ("sweep.csv", "sweep.h5", "sweep_checks.csv")
SECONDS = 240  # no single step may take longer
PATHS = os.environ["PATH"] + ":/usr/sbin:/sbin"
PROGRAM = REPO = None  # set in main

STUDY = """model = "multibody"
output = ["max:Rb1_z1", "mean:Td"]
minimise = ["max:Rb1_z1"]

[[vary]]
parameter = "pump.tilt_deg"
values = "20:40:#{tilts}"

[[vary]]
parameter = "pressure.delivery_bar"
values = "50:400:#20"
"""

CONFIGURATION = """ClusterName=bentaxis
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthInfo=socket={folder}/munge.socket
SlurmctldPort={ports[0]}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
StateSaveLocation={folder}/state
SlurmdPidFile={folder}/%n.pid
SlurmdLogFile={folder}/%n.log
SlurmdSpoolDir={folder}/%n
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmdTimeout=5
MinJobAge=3600
MailProg=/bin/true
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=2
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=2
PartitionName=all Nodes=n1,n2 Default=YES
"""

# Both nodes are this machine. Open MPI would take ranks of the other node for its own and look for them in shared memory.
TWO_NODES_ON_ONE_MACHINE = {"OMPI_MCA_btl": "self,tcp", "OMPI_MCA_btl_tcp_if_include": "lo"}


def tool(name):
    return shutil.which(name, path=PATHS)


def wait_for(what, condition):
    end = time.monotonic() + SECONDS
    while not (value := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"not after {SECONDS} s: {what}")
        time.sleep(0.05)
    return value


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


def children_of(pid):
    """Processes below one, as /proc has them now."""
    parents = {}
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parents[int(entry.name)] = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
            except OSError:
                continue
    found, todo = [], [pid]
    while todo:
        parent = todo.pop()
        below = [child for child, of in parents.items() if of == parent]
        found += below
        todo += below
    return found


class Cluster:
    """A controller and two nodes, n1 and n2, on this machine."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, {}
        folder.chmod(0o711)
        for name in ("state", "n1", "n2"):
            (folder / name).mkdir()
        (folder / "key").write_bytes(os.urandom(128))
        (folder / "key").chmod(0o400)
        configuration = CONFIGURATION.format(host=socket.gethostname().partition(".")[0], folder=folder, ports=free_ports(3),
                                             user=pwd.getpwuid(os.getuid()).pw_name)
        (folder / "slurm.conf").write_text(configuration)
        for node in ("n1", "n2"):  # each with a place of its own for what PMIx keeps: on two machines that is /tmp
            own = folder / f"{node}.conf"
            own.mkdir()
            (own / "slurm.conf").write_text(configuration)
            (own / "mpi.conf").write_text(f"PMIxCliTmpDirBase={folder}/{node}\n")
        self.environment = {**os.environ, "PATH": PATHS, "SLURM_CONF": str(folder / "slurm.conf")}
        self.start("munged", "--foreground", "--force", f"--key-file={folder}/key", f"--socket={folder}/munge.socket",
                   f"--pid-file={folder}/munged.pid", f"--seed-file={folder}/munge.seed", f"--log-file={folder}/munged.log")
        wait_for("munged", (folder / "munge.socket").exists)
        self.start("slurmctld", "-D")
        for node in ("n1", "n2"):
            self.start_node(node)

    def start(self, name, *arguments, key=None, **environment):
        with open(self.folder / f"{key or name}.out", "ab") as out:
            self.daemons[key or name] = subprocess.Popen([tool(name), *arguments], stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                                                         env=self.environment | environment, start_new_session=True)

    def start_node(self, node):
        for left in (self.folder / node).glob("*"):  # a machine that starts has an empty /tmp
            shutil.rmtree(left) if left.is_dir() else left.unlink()
        own = str(self.folder / f"{node}.conf/slurm.conf")
        self.start("slurmd", "-D", "-N", node, "-f", own, key=node, SLURM_CONF=own)
        wait_for(f"{node} is idle", lambda: self.state(node) == "idle")

    def said(self, *command, **options):
        return subprocess.run([tool(command[0]), *command[1:]], env=self.environment, text=True, capture_output=True,
                              timeout=SECONDS, **options)

    def start_now(self, number):
        """Slurm lets a job whose node has failed wait for two minutes."""
        self.said("scontrol", "update", f"JobId={number}", "StartTime=now")

    def state(self, node):
        return self.said("sinfo", "-h", "-N", "-n", node, "-o", "%t").stdout.strip()

    def job(self, number):
        """What Slurm says of a job, or of every task of an array: a list of fields."""
        return [dict(re.findall(r"(\w+)=(\S*)", line)) for line in
                self.said("scontrol", "-o", "show", "job", str(number)).stdout.splitlines()]

    def fail(self, node):
        """All processes of a node end at once, as when its power fails; Slurm is told nothing."""
        daemon = self.daemons.pop(node)
        for pid in [daemon.pid, *self.steps(node)]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        daemon.wait()

    def steps(self, node):
        """Step daemons of a node, which do not end with slurmd, and what they have started."""
        own = [pid for pid in map(int, filter(str.isdigit, os.listdir("/proc"))) if self.is_step(pid, node)]
        return own + [child for pid in own for child in children_of(pid)]

    def is_step(self, pid, node):
        try:
            environment = pathlib.Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
            name = pathlib.Path(f"/proc/{pid}/comm").read_text().strip()
        except OSError:
            return False
        return name.startswith("slurmstepd") and f"SLURM_CONF={self.folder}/{node}.conf/slurm.conf".encode() in environment

    def end(self):
        for node in ("n1", "n2"):
            if node in self.daemons:
                self.fail(node)
        for daemon in reversed(list(self.daemons.values())):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()


class ClusterTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """The sweep of all tests, and its results by one process with one thread."""
        cls.shared = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="bentaxis_")))
        (cls.shared / "bin").mkdir()
        (cls.shared / "bin/bentaxis").symlink_to(PROGRAM)
        cls.write_sweep(cls.shared)
        cls.expected = cls.alone(cls.shared)
        cls.mpi = "MPI none" not in subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_")))
        self.work = self.folder / "work"
        self.work.mkdir()
        self.write_sweep(self.work)
        shutil.copy(REPO / "docs/sweep.slurm", self.work)
        self.cluster = None
        self.addCleanup(lambda: self.cluster and self.cluster.end())
        (self.folder / "slurm").mkdir()
        self.cluster = Cluster(self.folder / "slurm")
        self.cluster.environment |= {"PATH": f"{self.shared}/bin:{PATHS}", **TWO_NODES_ON_ONE_MACHINE}

    @staticmethod
    def write_sweep(folder, tilts=6):
        shutil.copy(REPO / "cases/bap63_rated.toml", folder / "my.toml")
        (folder / "study.toml").write_text(STUDY.format(tilts=tilts))

    @classmethod
    def alone(cls, folder):
        """Results of one process with one thread."""
        subprocess.run([PROGRAM, "sweep", "my.toml", "--study", "study.toml", "--check", "0.1%", "--out", "alone", "--threads", "1"],
                       cwd=folder, check=True, capture_output=True, timeout=SECONDS)
        return cls.results(folder / "alone")

    @staticmethod
    def results(folder):
        return {name: (folder / name).read_bytes() for name in RESULTS if (folder / name).exists()}

    def sbatch(self, *arguments, **environment):
        """Number of a job, or its refusal."""
        self.cluster.environment |= environment
        done = self.cluster.said("sbatch", "--parsable", *arguments, cwd=self.work)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in environment:
            del self.cluster.environment[name]
        return int(done.stdout)

    def parts(self, array, **environment):
        return self.sbatch(f"--array={array}", "--nodes=1", "--ntasks=1", "--ntasks-per-node=1", "--cpus-per-task=1", "sweep.slurm",
                           **environment)

    def merge(self, after):
        return self.sbatch(f"--dependency=afterok:{after}", "--nodes=1", "--wrap", "bentaxis merge sweep_out")

    def ends(self, job, state="COMPLETED"):
        """Waits for a job and all tasks of its array; returns what Slurm says of them."""
        over = ("COMPLETED", "FAILED", "CANCELLED", "NODE_FAIL", "TIMEOUT", "BOOT_FAIL", "OUT_OF_MEMORY")
        wait_for(f"job {job} ends", lambda: all(task["JobState"] in over for task in self.cluster.job(job)))
        tasks = self.cluster.job(job)
        said = "".join(file.read_text() for file in sorted(self.work.glob("slurm-*.out")))
        self.assertEqual({task["JobState"] for task in tasks}, {state}, said)
        return tasks

    def blocks(self):
        """Numbers of the finished blocks; part 3 of 5 has 2, 7, 12, .."""
        return [int(file.stem.rpartition("-")[2]) for file in (self.work / "sweep_out/sweep.parts").glob("*.bin")]

    def output(self, job):
        return "".join(file.read_text() for file in sorted(self.work.glob(f"slurm-{job}*.out")))

    def equal(self):
        self.assertGreaterEqual(set(self.expected), {"sweep.csv", "sweep_checks.csv"})
        found = self.results(self.work / "sweep_out")
        self.assertEqual(set(found), set(self.expected))
        for name, content in self.expected.items():
            self.assertTrue(found[name] == content, f"{name} differs from that of one process")

    def with_mpi(self):
        if not self.mpi:
            self.skipTest("built without MPI")

    # ---- A job array ---------------------------------------------------------------------------------

    def test_an_array_on_two_nodes_and_merge(self):
        job = self.parts("1-5")
        merge = self.merge(job)
        tasks = self.ends(job)
        self.assertEqual(len(tasks), 5)
        self.assertEqual({task["BatchHost"] for task in tasks}, {"n1", "n2"})
        self.ends(merge)
        self.equal()
        # The comparison is able to fail: another study has other results.
        other = self.folder / "other"
        other.mkdir()
        self.write_sweep(other, tilts=7)
        self.assertNotEqual(self.alone(other)["sweep.csv"], self.expected["sweep.csv"])

    def test_a_lost_part_is_named_and_submitted_again(self):
        job = self.parts("1-5")
        never = self.merge(job)
        wait_for("task 3 has blocks", lambda: any(number % 5 == 2 for number in self.blocks()))
        self.cluster.said("scancel", "--signal=KILL", "--full", f"{job}_3")
        wait_for("the array ends", lambda: all(t["JobState"] in ("COMPLETED", "FAILED", "CANCELLED") for t in self.cluster.job(job)))
        states = {task["ArrayTaskId"]: task["JobState"] for task in self.cluster.job(job)}
        self.assertNotEqual(states.pop("3"), "COMPLETED")
        self.assertEqual(set(states.values()), {"COMPLETED"})
        wait_for("the merge that depends on all parts never starts", lambda: self.cluster.job(never)[0]["Reason"] == "DependencyNeverSatisfied")
        merge = self.sbatch("--nodes=1", "--wrap", "bentaxis merge sweep_out")
        self.ends(merge, "FAILED")
        self.assertRegex(self.output(merge), "sweep.parts: .*missing or damaged: .*[0-9]")
        # An array of the lost part alone does not say how many parts there are: refused, not computed wrongly.
        wrong = self.parts("3")
        self.ends(wrong, "FAILED")
        self.assertIn("state the number of parts, PARTS=N", self.output(wrong))
        again = self.parts("3", PARTS="5")
        self.ends(again)
        self.assertRegex(self.output(again), "[0-9]+ blocks were there already")
        self.ends(self.merge(again))
        self.equal()

    def test_a_node_fails_under_an_array(self):
        job = self.parts("1-5")
        wait_for("both nodes compute", lambda: len(self.blocks()) > 10 and
                 {task.get("BatchHost") for task in self.cluster.job(job) if task["JobState"] == "RUNNING"} == {"n1", "n2"})
        self.assertTrue(self.cluster.steps("n2"))
        self.cluster.fail("n2")
        wait_for("Slurm notices", lambda: self.cluster.state("n2").startswith("down"))
        for task in self.cluster.job(job):
            if task["JobState"] == "PENDING" and task["Restarts"] != "0":
                self.cluster.start_now(task["JobId"])
        tasks = self.ends(job)
        self.assertTrue(any(task["Restarts"] != "0" for task in tasks))
        self.assertEqual({task["BatchHost"] for task in tasks if task["Restarts"] != "0"}, {"n1"})
        self.ends(self.merge(job))
        self.equal()

    # ---- Ranks ---------------------------------------------------------------------------------------

    def ranks(self):
        return self.sbatch("--nodes=2", "--ntasks-per-node=2", "sweep.slurm")

    def test_ranks_on_two_nodes(self):
        self.with_mpi()
        task, = self.ends(self.ranks())
        self.assertEqual((task["NumNodes"], task["NumTasks"]), ("2", "4"))
        self.equal()
        self.assertFalse((self.work / "sweep_out/sweep.parts").exists())

    def test_a_lost_rank_ends_the_job_and_the_next_one_goes_on(self):
        self.with_mpi()
        job = self.ranks()
        wait_for("there are blocks", lambda: len(self.blocks()) > 10)
        ranks = [pid for pid in self.cluster.steps("n2") if pathlib.Path(f"/proc/{pid}/comm").read_text().strip() == "bentaxis"]
        self.assertEqual(len(ranks), 2)
        os.kill(ranks[0], signal.SIGKILL)
        self.ends(job, "FAILED")
        self.assertFalse((self.work / "sweep_out/sweep.csv").exists())
        again = self.ranks()
        self.ends(again)
        self.assertRegex(self.output(again), "[1-9][0-9]* blocks were there already")
        self.equal()

    def test_a_node_fails_under_ranks(self):
        self.with_mpi()
        job = self.ranks()
        wait_for("there are blocks", lambda: len(self.blocks()) > 10)
        self.cluster.fail("n2")
        wait_for("Slurm notices and starts the job again later", lambda: self.cluster.job(job)[0]["JobState"] == "PENDING")
        self.assertFalse((self.work / "sweep_out/sweep.csv").exists())
        self.cluster.start_node("n2")
        self.cluster.start_now(job)
        task, = self.ends(job)
        self.assertEqual(task["Restarts"], "1")
        self.assertRegex(self.output(job), "[1-9][0-9]* blocks were there already")
        self.equal()


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    missing = [name for name in NEEDED if tool(name) is None]
    if missing:
        print(f"skipped: Slurm is not installed (scripts/setup slow): no {', '.join(missing)}")
        sys.exit(SKIPPED)
    PROGRAM, REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
