#!/bin/bash
# check_readme.sh - what the documents show works: the C programs in the header's manual and in README.md compile
# without a warning and run, as do README.md's programs in Python; the README's make commands exist, its
# shell blocks and the examples of --help run as they are printed, in sh and (where it is installed) in zsh, and the
# files it names are there.
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

for number, code in enumerate(code for language, code in fences if language == "python"):
    open(f"{out}/python_{number}.py", "w").write(code)
    for name in re.findall(r'load\("([^"]+\.obj)"', code): write_mesh(f"{out}/{name}")

shell = "\n".join(code for language, code in fences if language in ("", "sh", "bash", "console", "shell"))
commands = re.findall(r"^\s*(?:\$ )?(?:.*(?:&&|;)\s*)?(make\b[^#;&|\n]*)", shell, re.M)
commands += re.findall(r"`(make [^`\n&;|]+)", readme)
open(f"{out}/make.list", "w").write("".join(c.strip() + "\n" for c in dict.fromkeys(commands)))
# Shell blocks are run in a folder that looks like the repository: one command a line of the list.
os.makedirs(f"{out}/clone/tools")
for name in os.listdir(root):
    if name != "tools": os.symlink(os.path.join(root, name), f"{out}/clone/{name}")
for name in os.listdir(os.path.join(root, "tools")):
    if name != "guidedproj": os.symlink(os.path.join(root, "tools", name), f"{out}/clone/tools/{name}")
help = open(f"{out}/help.txt").read()
examples = re.search(r"^examples\n(.*?)^$", help + "\n\n", re.M | re.S)
shown = shell + "\n" + (examples.group(1) if examples else "")
commands = [c.strip() for c in re.sub(r"\\\n\s*", " ", shown).split("\n") if c.strip() and not c.strip().startswith("#")]
open(f"{out}/shell.list", "w").write("".join(c + "\n" for c in commands))
# What zsh would take for a pattern, or for the path of a command, must stand in quotes.
bare = [(c, re.sub(r"'[^']*'|\"[^\"]*\"", "", c)) for c in commands]
open(f"{out}/glob.list", "w").write("".join(c + "\n" for c, b in bare if re.search(r"[*?\[\]{}~^]|\s=", b)))
# Relative links and pictures must exist.
links = [l for l in re.findall(r"\]\(([^)#\s]+)[^)]*\)|src=\"([^\"]+)\"", readme) for l in l if l and ":" not in l]
open(f"{out}/links.list", "w").write("".join(l + "\n" for l in links if not os.path.exists(os.path.join(root, l))))
END
tool=$(realpath "${GPROJ_TOOL:-build/tool}")
touch "$work/help.txt"
[ ! -x "$tool" ] || "$tool" --help >"$work/help.txt"
python3 "$work/readme.py" "$root" "$work" || fail 'readme.py'
compile="gcc -std=c99 -O1 -Wall -Wextra -Wpedantic -Werror -I'$root'"
library=$(existing build/library.a) # compiled once for all tests; alone this script compiles it with each program
for where in manual readme; do
    found=0
    for program in "$work/${where}"_*.c; do
        [ -f "$program" ] || continue
        found=1 name=$(basename "$program" .c)
        job "program of the $where does not compile ($name)" \
            "$compile -fsyntax-only '$program' && $compile ${library:+-DGPROJI_IMPLEMENTED} '$program' $library -lm -o $name"
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

python=$(python_with_numpy)
[ -f "$work/python_0.py" ] && pass || fail 'no program in Python found in README.md'
for program in "$work"/python_*.py; do
    [ -n "$python" ] || { skip 'README.md: Python: no python3 with numpy (Debian: python3-numpy)'; break; }
    # One cache for all tests.
    if (cd "$work" && GUIDEDPROJ_CACHE=$OLDPWD/build/python PYTHONPATH=$root/examples/python timeout 120 \
        $python -B "$program" >"$work/python.txt" 2>&1 </dev/null); then
        pass
    else
        fail "README.md: $(basename "$program") ends with an error"
        tail -n 20 "$work/python.txt"
    fi
done

if [ -f "$root/README.md" ]; then
    [ -s "$work/make.list" ] && pass || fail 'README.md has no make command'
    grep -qx 'make -C tests' "$work/make.list" && pass || fail 'README.md does not name make -C tests'
    while read -r command; do
        # -n: what would be done, without doing it; exit code 2 for a target or folder that does not exist
        answer=$(cd "$root" && MAKEFLAGS='' eval "make -n ${command#make }" 2>&1 >/dev/null </dev/null) && answer=''
        clean "README.md: $command" "$answer"
    done <"$work/make.list"
    # A make that only says what it would do; the tool is the one that was built for the tests.
    mkdir "$work/bin"
    printf '#!/bin/sh\nexec %s -n "$@"\n' "$(command -v make)" >"$work/bin/make"
    chmod +x "$work/bin/make"
    [ ! -x "$tool" ] || ln -s "$tool" "$work/clone/tools/guidedproj"
    [ "$(grep -c 'guidedproj ' "$work/shell.list")" -ge 8 ] && pass || fail 'README.md and --help show too few commands'
    clean 'README.md, --help: patterns without quotes' "$(cat "$work/glob.list")"
    for shell in sh zsh; do
        if [ ! -x "$tool" ] || ! have $shell; then
            skip "README.md, --help: the commands in $shell: no $shell or no tool"
            continue
        fi
        cp -R "$work/clone" "$work/$shell"
        while IFS= read -r command; do
            if (cd "$work/$shell" && MAKEFLAGS='' PATH="$work/bin:$work/clone/tools:$PATH" \
                timeout 120 $shell -c "$command" >"$work/shell.txt" 2>&1 </dev/null); then
                pass
            else
                fail "$shell, exit code $?: $command"
                grep -v '^iteration' "$work/shell.txt" | head -n 20
            fi
        done <"$work/shell.list"
    done
    clean 'README.md: files that do not exist' "$(cat "$work/links.list")"
else
    fail 'no README.md'
fi
report
