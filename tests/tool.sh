# tool.sh - what the tests of the command line begin with: `here`, the `tool` (TOOL, or ../tools/guidedproj), a folder for
# `work` that is removed at the end, and counts.
here=$(cd "$(dirname "$0")" && pwd)
tool=${TOOL:-$here/../tools/guidedproj}
case $tool in /*) ;; *) tool=$PWD/$tool ;; esac
work=$(mktemp -d) || exit 2
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0
export LC_ALL=C

pass() { passed=$((passed + 1)); }
fail() { failed=$((failed + 1)); echo "FAILED: $*"; }
skip() { skipped=$((skipped + 1)); echo "skipped: $*"; }
