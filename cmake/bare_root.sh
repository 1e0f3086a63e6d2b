# shellcheck shell=bash
# Bare roots of Debian for scripts that source this file. Root only; debootstrap makes them from the mirror that this
# machine's apt uses.
#
#   why="$(why_no_roots)" || …           # says what is missing, where it is no machine for this
#   with_own_mounts "$@"                 # starts the script again, in a namespace of mounts that ends with it
#   make_root user bookworm              # $work/user; $work goes in the end, with all roots in it
#   in_root user bernal --version        # as root, with nothing of this environment
#   as_user user bernal --version        # as a user who owns a home and nothing else
#   apt_in user install zsh
#   ccache_in user                       # in_root user env "${cached[@]}" …: by ccache, in BERNAL_CCACHE if that names one
#
# BERNAL_ROOTS names a folder that keeps what debootstrap has made, as SUITE.tar: the next root of that suite is
# unpacked from there. Whoever wants the Debian of today removes these files.
why_no_roots() {
  ((EUID == 0)) || { echo "only root may make roots"; return 1; }
  local program
  for program in debootstrap unshare; do
    command -v "$program" >/dev/null || { echo "$program is not installed"; return 1; }
  done
  [[ -n "$(debian_mirror)" ]] || { echo "apt has no source of Debian"; return 1; }
}

# One mirror has every suite. Of security updates it has none: those of old stable releases come by point releases.
debian_mirror() {
  apt-get indextargets --format '$(REPO_URI) $(LABEL)' 'Created-By: Packages' 2>/dev/null |
    awk '$2 == "Debian" { print $1; exit }'
}

with_own_mounts() {
  if [[ "${BERNAL_OWN_MOUNTS:-}" != "$0" ]]; then
    exec env BERNAL_OWN_MOUNTS="$0" unshare --mount --propagation private "$0" "$@"
  fi
  work="$(mktemp -d "${TMPDIR:-/tmp}/bernal.XXXXXX")"
  chmod 755 "$work"
  trap remove_roots EXIT
  trap 'exit 1' INT TERM HUP
  export LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive
}

# What was mounted there may be a folder of others, and on the same file system: nothing is removed before it is gone.
remove_roots() {
  local each mounted
  mapfile -t mounted < <(awk -v below="$work/" 'index($5, below) == 1 { print $5 }' /proc/self/mountinfo | tac)
  for each in "${mounted[@]}"; do
    umount --lazy "$(printf %b "$each")"  # a blank is \040 there
  done
  if grep --quiet --fixed-strings " $work/" /proc/self/mountinfo; then
    echo "$work is left: something is mounted there" >&2
  else
    rm -rf --one-file-system "$work"
  fi
}

make_root() {
  local root="$work/$1" suite="$2" kept="${BERNAL_ROOTS:+$BERNAL_ROOTS/$2.tar}"
  mkdir -p "$root"
  if [[ -n "$kept" && -e "$kept" ]]; then
    tar --extract --numeric-owner --file "$kept" --directory "$root" || return
  else
    debootstrap --variant=minbase "$suite" "$root" "$(debian_mirror)" || return
    rm -f "$root"/var/cache/apt/archives/*.deb
    if [[ -n "$kept" ]]; then  # whole at once: others may be reading
      mkdir -p "$BERNAL_ROOTS"
      tar --create --numeric-owner --one-file-system --file "$kept.$$" --directory "$root" . && mv "$kept.$$" "$kept" ||
        return
    fi
  fi
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io"  # no root outlives a power cut
  local kind proxy
  for kind in http https; do
    proxy="$(apt-config dump --format '%v%n' "Acquire::$kind::Proxy")"
    [[ -z "$proxy" ]] || echo "Acquire::$kind::Proxy \"$proxy\";" >>"$root/etc/apt/apt.conf.d/90proxy"
  done
  cp --dereference /etc/resolv.conf "$root/etc/resolv.conf" &&
    mount -t proc proc "$root/proc" &&
    mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts" &&
    ln -sf pts/ptmx "$root/dev/ptmx" || return
  # Of what was kept, the lists of packages may be old. As debootstrap, it does not ask how old those of the mirror are.
  [[ -z "$kept" ]] || apt_in "$1" -o Acquire::Check-Valid-Until=false update
}

# What is in both: no variable of this machine, and what comes after the root.
inside=(env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 TERM=dumb
  DEBIAN_FRONTEND=noninteractive)

in_root() {
  local root="$work/$1"
  shift
  "${inside[@]}" HOME=/root chroot "$root" "$@"
}

as_user() {
  local root="$work/$1"
  shift
  [[ -d "$root/home/user" ]] || "${inside[@]}" chroot "$root" useradd --create-home --uid 1000 user || return
  "${inside[@]}" HOME=/home/user USER=user chroot --userspec=1000:1000 --groups= "$root" "$@"
}

apt_in() {
  local root="$1"
  shift
  in_root "$root" apt-get --yes --quiet=2 "$@" </dev/null
}

# shellcheck disable=SC2034  # those who source this use it
# Leaves in $cached the variables by which what is compiled in a root is kept in BERNAL_CCACHE; none without that.
ccache_in() {
  cached=()
  [[ -n "${BERNAL_CCACHE:-}" ]] || return 0
  mkdir -p "$BERNAL_CCACHE" "$work/$1/ccache"
  mount --bind "$BERNAL_CCACHE" "$work/$1/ccache"
  apt_in "$1" install --no-install-recommends ccache >/dev/null || return
  # Precompiled headers need the last two.
  cached=(CCACHE_DIR=/ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache CXXFLAGS=-fpch-preprocess
    "CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime")
}
