# For scripts that try on bare roots what users get: one line tells of each thing that was tried, and the first that
# fails ends the script.
source="$(readlink -f "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../..")"
source "$source/cmake/bare_root.sh"
built_in=/build/bernal-[0-9.]*  # in the roots of cmake/release

skip() { echo "skipped: $*"; exit 77; }
why="$(why_no_roots)" || skip "$why"

done_so_far=0
fail() { echo "FAILED: $*" >&2; exit 1; }
# tries WHAT COMMAND…: runs it, shows what it said only if it fails.
tries() {
  local what="$1" status=0
  shift
  ("$@") >"$work/log" 2>&1 || status=$?
  ((status == 0)) || { cat "$work/log" >&2; fail "$what (exit code $status)"; }
  done_so_far=$((done_so_far + 1))
  echo "ok  $what"
}
prints() { grep -qF -- "$1" "$work/log" || { cat "$work/log" >&2; fail "\"$1\" was not printed"; }; }
refuses() { ! "$@"; }
