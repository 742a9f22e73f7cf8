#!/bin/bash
# test_web.sh - the interactive page, tools/web, in headless Chromium: test_web.js clicks, drags and looks at the pixels.
# Skipped where something that the page or the browser needs is missing.
. "$(dirname "$0")/tool.sh"

done_here() { echo "$passed passed, $failed failed, $skipped skipped"; exit $((failed > 0)); }
for program in node chromedriver chromium python3; do
    command -v $program >/dev/null || { skip "the page in a browser: no $program (Debian: chromium chromium-driver nodejs)"; done_here; }
done
node -e 'process.exit(typeof fetch === "function" ? 0 : 1)' || { skip 'the page in a browser: node is older than 18'; done_here; }
page=$work/build/guidedproj.html
mkdir -p "$work/build"
if ! ${MAKE:-make} --no-print-directory -C "$here/../tools/web" BUILD="$work/build" >"$work/make.txt" 2>&1; then
    fail 'tools/web does not build:'
    cat "$work/make.txt"
    done_here
fi
[ -f "$page" ] || { skip "the page in a browser: $(cat "$work/make.txt")"; done_here; }
CHROMIUM=$(command -v chromium) node "$here/test_web.js" "$page" "$work" "$tool" "$here/.."
