#!/usr/bin/env python3
"""coverage.py FOLDER HEADER LINES BRANCHES [--lines] - adds up gcov's counts of one header over many programs.

Programs may have their own copies of the header's functions. A line counts as covered when it ran in any program, a branch
when it was taken in any; branches are the same when function, line and position in the line are. --lines also prints
the lines that never ran, and those with branches never taken. Fails when fewer than LINES percent of the lines or BRANCHES
percent of the branches are covered.
"""
import glob, json, os, subprocess, sys

folder, header = sys.argv[1], os.path.realpath(sys.argv[2])
lines, branches = {}, {}  # line -> runs; (function, line, occurrence, position) -> times taken
notes = sorted(glob.glob(f"{folder}/**/*.gcno", recursive=True))
for note in notes:
    answer = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", os.path.basename(note)],
                            cwd=os.path.dirname(note), capture_output=True, text=True)
    for text in answer.stdout.splitlines():
        data = json.loads(text)
        for file in data["files"]:
            if os.path.realpath(os.path.join(data["current_working_directory"], file["file"])) != header:
                continue
            seen = {}
            for line in file["lines"]:
                number, function = line["line_number"], line.get("function_name", "")
                lines[number] = lines.get(number, 0) + line["count"]
                occurrence = seen[function, number] = seen.get((function, number), -1) + 1
                for position, branch in enumerate(line["branches"]):
                    key = function, number, occurrence, position
                    branches[key] = branches.get(key, 0) + branch["count"]
if not lines:
    sys.exit(f"coverage: nothing measured in {len(notes)} programs")

missed = [n for n, count in sorted(lines.items()) if not count]
half = {}
for (_, number, _, _), count in branches.items():
    if lines[number]:
        half.setdefault(number, [0, 0])
        half[number][0] += count > 0
        half[number][1] += 1
if "--lines" in sys.argv:
    source = open(header, encoding="utf-8").read().split("\n")
    for number in sorted(set(missed) | {n for n, (taken, of) in half.items() if taken < of}):
        mark = "never" if not lines[number] else "%d of %d" % tuple(half[number])
        print(f"{number:6}: {mark:>8}  {source[number - 1]}")
taken = sum(count > 0 for count in branches.values())
enough = True
for what, part, whole, least in (("lines", len(lines) - len(missed), len(lines), float(sys.argv[3])),
                                 ("branches", taken, len(branches), float(sys.argv[4]))):
    percent = 100 * part / max(whole, 1)
    enough = enough and percent >= least
    print(f"coverage of {os.path.basename(header)}: {percent:.2f} % of {whole} {what} (at least {least:g} % wanted)")
sys.exit(not enough)
