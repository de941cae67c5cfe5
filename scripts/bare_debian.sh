# A Debian 12 that has nothing but its base system, for scripts that source this; needs root, debootstrap, and a Debian mirror as
# apt on this machine uses it.
#   make_bare_debian DIR [PACKAGE..]    DIR: new folder, or ""; sets $bare. What was made for "" is removed at the end
#   in_bare_debian COMMAND..            runs there, without this machine's environment
make_bare_debian() {
  ((EUID == 0)) || { echo "$(basename "$0"): needs root" >&2; exit 1; }
  command -v debootstrap > /dev/null || { echo "$(basename "$0"): needs debootstrap (scripts/setup slow)" >&2; exit 1; }
  bare_given=$1
  shift
  bare=${bare_given:-$(mktemp -d /var/tmp/bentaxis_bare_XXXXXX)}
  trap clean_bare_debian EXIT
  local mirror packages
  packages=$(IFS=,; echo "ca-certificates${*:+,$*}")
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Codename: bookworm' 2> /dev/null | head -n 1)
  debootstrap --variant=minbase --include="$packages" bookworm "$bare" "${mirror:-http://deb.debian.org/debian}" > "$bare.log" 2>&1 || {
    tail -n 20 "$bare.log"
    exit 1
  }
  rm -f "$bare.log"
  # The package sources and certificates of this machine, so that the same mirror serves.
  rm -f "$bare"/etc/apt/sources.list
  cp -rL /etc/apt/. "$bare/etc/apt/"
  cp -rL /usr/local/share/ca-certificates/. "$bare/usr/local/share/ca-certificates/" 2> /dev/null || true
  cp /etc/resolv.conf /etc/hosts "$bare/etc/" 2> /dev/null || true
  chroot "$bare" update-ca-certificates > /dev/null 2>&1 || true
  mount -t proc proc "$bare/proc"
  # A slave: what is unmounted there stays on this machine.
  mount --rbind --make-rslave /sys "$bare/sys" 2> /dev/null || true
  mkdir -p "$bare/dev/shm" && mount -t tmpfs shm "$bare/dev/shm" || true
  # A machine has terminals.
  mkdir -p "$bare/dev/pts" && mount -t devpts -o newinstance,ptmxmode=0666 devpts "$bare/dev/pts" || true
}
clean_bare_debian() {
  umount -q -R "$bare/proc" "$bare/sys" "$bare/dev/shm" "$bare/dev/pts" 2> /dev/null || true
  [[ -n $bare_given ]] || rm -rf --one-file-system "$bare"
}
in_bare_debian() {
  env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} chroot "$bare" "$@"
}
