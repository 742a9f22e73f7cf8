#!/bin/bash
# check_readme.sh - what the documents show works: the C programs in the header's manual and in README.md compile
# without a warning and run; the README's make commands exist, its tools/guidedproj commands succeed, and the files it
# names are there.
#
# A program in the manual begins at a line "#define GUIDEDPROJ_IMPLEMENTATION" and ends at the "}" in the same column. In
# the README it is a fenced block ```c with a main. Meshes that a program loads are put there for it to find.
. "$(dirname "$0")/checks.sh"

have python3 && have gcc || { skip 'programs of the documents: no python3 or no gcc'; report; }
cat >"$work/readme.py" <<'END'
import os, re, sys
root, out = sys.argv[1:]

def read(name):
    path = os.path.join(root, name)
    return open(path, encoding="utf-8").read() if os.path.exists(path) else ""

def write_mesh(path):  # a vault of 6 x 6 quads, dented inside
    if os.path.exists(path): return
    with open(path, "w") as mesh:
        for i in range(49): mesh.write(f"v {i % 7} {i // 7} {i % 7 * (6 - i % 7) / 9 * (1 + (i // 7) * (6 - i // 7) * (i % 3) / 99) + i // 7 * (6 - i // 7) / 12}\n")
        for i in range(42):
            if i % 7 < 6: mesh.write(f"f {i + 1} {i + 2} {i + 9} {i + 8}\n")
header, readme = read("guidedproj.h"), read("README.md")

manual = re.split(r"^#ifndef GUIDEDPROJ_H", header, flags=re.M)[0].split("\n")
programs = []
for first, line in enumerate(manual):
    start = re.match(r"([ \t]+)#[ \t]*define GUIDEDPROJ_IMPLEMENTATION\b", line)
    if not start: continue
    for last in range(first, len(manual)):
        if manual[last].rstrip() == start.group(1) + "}":
            programs.append(("manual", "\n".join(l[len(start.group(1)):] for l in manual[first:last + 1])))
            break
fences = re.findall(r"^```(\w*)[^\n]*\n(.*?)^```", readme, re.M | re.S)
programs += [("readme", code) for language, code in fences if language == "c" and re.search(r"\bmain\s*\(", code)]
for number, (where, code) in enumerate(programs):
    # A comment cannot hold another: the manual writes its programs' comments as // or not at all.
    open(f"{out}/{where}_{number}.c", "w").write(code + "\n")
    for name in re.findall(r'gproj_mesh_load\("([^"]+\.obj)"', code):
        write_mesh(f"{out}/{name}")

shell = "\n".join(code for language, code in fences if language in ("", "sh", "bash", "console", "shell"))
commands = re.findall(r"^\s*(?:\$ )?(?:.*(?:&&|;)\s*)?(make\b[^#;&|\n]*)", shell, re.M)
commands += re.findall(r"`(make [^`\n]+)`", readme)
open(f"{out}/make.list", "w").write("".join(c.strip() + "\n" for c in dict.fromkeys(commands)))
# Commands of the tool are run in a folder that looks like the repository.
os.mkdir(f"{out}/clone")
for name in os.listdir(root): os.symlink(os.path.join(root, name), f"{out}/clone/{name}")
joined = shell.replace("\\\n", " ")
tool = re.findall(r"^\s*(?:\$ )?(?:.*(?:&&|;)\s*)?(?:\./)?tools/guidedproj\b([^#;&|\n]*)", joined, re.M)
for arguments in tool:
    for name in arguments.split()[:1]:
        if re.search(r"\.obj$", name) and "/" not in name: write_mesh(f"{out}/clone/{name}")
open(f"{out}/tool.list", "w").write("".join(arguments.strip() + "\n" for arguments in tool))
# Relative links and pictures must exist.
links = [l for l in re.findall(r"\]\(([^)#\s]+)[^)]*\)|src=\"([^\"]+)\"", readme) for l in l if l and ":" not in l]
open(f"{out}/links.list", "w").write("".join(l + "\n" for l in links if not os.path.exists(os.path.join(root, l))))
END
python3 "$work/readme.py" "$root" "$work" || fail 'readme.py'
for where in manual readme; do
    found=0
    for program in "$work/${where}"_*.c; do
        [ -f "$program" ] || continue
        found=1 name=$(basename "$program" .c)
        job "program of the $where does not compile ($name)" \
            "gcc -std=c99 -O1 -Wall -Wextra -Wpedantic -Werror -I'$root' '$program' -lm -o $name"
    done
    [ $found = 1 ] || fail "no C program found in the $where"
done
run_jobs
for program in "$work"/manual_*.c "$work"/readme_*.c; do
    name=$(basename "$program" .c)
    [ -x "$work/$name" ] || continue
    if (cd "$work" && timeout 60 "./$name" >"$name.txt" 2>&1 </dev/null); then
        pass
    else
        fail "the $name program ends with exit code $?"
        head -n 20 "$work/$name.txt"
    fi
done

if [ -f "$root/README.md" ]; then
    [ -s "$work/make.list" ] && pass || fail 'README.md has no make command'
    grep -qx 'make -C tests' "$work/make.list" && pass || fail 'README.md does not name make -C tests'
    while read -r command; do
        # -n: what would be done, without doing it; exit code 2 for a target or folder that does not exist
        answer=$(cd "$root" && MAKEFLAGS='' eval "make -n ${command#make }" 2>&1 >/dev/null) && answer=''
        clean "README.md: $command" "$answer"
    done <"$work/make.list"
    tool=$(realpath "${GPROJ_TOOL:-build/tool}")
    while read -r arguments; do
        if [ ! -x "$tool" ]; then
            skip "README.md: tools/guidedproj $arguments: no tool"
        elif (cd "$work/clone" && eval "timeout 120 '$tool' $arguments" >"$work/tool.txt" 2>&1 </dev/null); then
            pass
        else
            fail "README.md: tools/guidedproj $arguments: exit code $?"
            head -n 20 "$work/tool.txt"
        fi
    done <"$work/tool.list"
    clean 'README.md: files that do not exist' "$(cat "$work/links.list")"
else
    fail 'no README.md'
fi
report
