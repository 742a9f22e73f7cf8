#!/bin/bash
# test_tool_random.sh - the first cases of fuzz_tool.py, always the same ones: random options on small random files.
#
#     TOOL=../tools/guidedproj ./test_tool_random.sh

. "$(dirname "$0")/tool.sh"
[ -x "$tool" ] || { echo "there is no tool at $tool: build it first, or set TOOL"; exit 2; }
if ! command -v python3 >/dev/null; then
    echo 'skip: there is no python3'
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
fi
python3 "$here/fuzz_tool.py" "$tool" 1 400
