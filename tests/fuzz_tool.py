#!/usr/bin/env python3
"""fuzz_tool.py TOOL FIRST COUNT [SECONDS] - runs the command line with random options on small random files.

Case n is made from the number n alone, so FIRST and COUNT name the cases; with SECONDS it goes on after them until the
time is over. What is checked: the process ends by itself within its processor time, with a documented status and no word
of a sanitizer; after 0 and 1 the output is there, with finite numbers and as many vertices as asked for; after 2, 3 and 4
no output is touched, and there is a sentence; nothing else is left in the folder; the same case gives the same bytes.
Prints what fails, with the command, and at the end "N passed, N failed".
"""
import math, os, random, resource, shutil, subprocess, sys, tempfile, time

NUMBERS = ["0", "1", "-1", "0.5", "1e-9", "1e300", "-1e300", "nan", "inf", "x1.1", "x0", "", "1e", "7", "2147483648", "0x10", "1,5"]
# Options with what may follow: w a weight, s a schedule, n a number, r a range, v vertices, f a file, - nothing.
OPTIONS = {"planar": "-w", "circular": "-w", "conical": "-w", "equal-lengths": "-w", "edge-length": "r", "face-area": "r",
           "total-area": "n", "cost": "c", "planar-boundary": "-w", "straight-boundary": "-w", "orthogonal-boundary": "-w",
           "lifting": "-w", "volume": "n", "fix": "v", "glide": "v", "move": "m", "equilibrium": "-w", "compressive": "-w",
           "tensile": "-w", "stress": "r", "supports": "v", "density": "n", "area-load": "n", "snow": "n", "loads": "l",
           "force-fairness": "-w", "reference": "f", "closeness": "s", "fairness": "s", "boundary-fairness": "s", "tangential": "s",
           "gauss": "s", "parallelograms": "-w", "equal-areas": "-w", "nearest": "-", "plain": "-", "iterations": "i", "tolerance": "n",
           "epsilon": "n", "allow-spoiled": "-", "threads": "i", "quiet": "-", "weld": "-n", "encoding": "o", "lift": "n", "subdivide": "i",
           "cage": "f", "start-forces": "f", "sides": "v", "view": "e", "colour": "k", "title": "f", "file-limit": "i", "sheet": "h", "panel-scale": "n", "diagonals": "-", "frobnicate": "-n"}
OUTPUTS = {"report": "out.json", "forces": "out.csv", "picture": "out.svg", "state": "out.state", "support": "panels.obj",
           "panels": "out.dxf", "panel-list": "list.csv"}


def grid(rng):
    """Lines of a small OBJ or OFF, right or with something wrong."""
    n, m = rng.randint(1, 4), rng.randint(1, 4)
    points = [(i + 0.1 * rng.random(), j + 0.1 * rng.random(), 0.5 * rng.random()) for i in range(n + 1) for j in range(m + 1)]
    faces = [[i * (m + 1) + j, (i + 1) * (m + 1) + j, (i + 1) * (m + 1) + j + 1, i * (m + 1) + j + 1]
             for i in range(n) for j in range(m)]
    if rng.random() < 0.3: faces = [t for a, b, c, d in faces for t in ([a, b, c], [a, c, d])]
    if rng.random() < 0.1: points[rng.randrange(len(points))] = points[0]
    if rng.random() < 0.1: faces.append(rng.choice(faces))
    scale = rng.choice([1, 1, 1, 1, 1e-6, 1e6, 1e60])
    numbers = [" ".join(repr(scale * x) for x in p) for p in points]
    if rng.random() < 0.2:
        text = "\n".join(["OFF", f"{len(points)} {len(faces)} 0"] + numbers + [f"{len(f)} " + " ".join(map(str, f)) for f in faces])
    else:
        text = "\n".join(["v " + p for p in numbers] + ["f " + " ".join(str(v + 1) for v in f) for f in faces])
    if rng.random() < 0.2: text += "\nl 1 2\n"
    data = bytearray(text.encode() + b"\n")
    if rng.random() < 0.15: data[rng.randrange(len(data))] = rng.randrange(256)
    if rng.random() < 0.05: del data[rng.randrange(len(data)):]
    return bytes(data), len(points)


def value(rng, kind, vertices, wildness):
    number = lambda: rng.choice(NUMBERS) if rng.random() < wildness else repr(round(rng.uniform(0.1, 3), 2))
    if kind == "w": return number()
    if kind == "s":
        decay = "*" + repr(round(rng.random(), 2)) if rng.random() < 0.3 else ""
        return number() + decay + (":%d" % rng.randint(1, 9) if rng.random() < 0.2 else "")
    if kind == "r": return ",".join(rng.choice([[number(), ""], ["", number()], ["0.2", number() + "9"]]))
    if kind == "c": return ",".join(number() for _ in range(3))
    if kind == "m": return ",".join([str(rng.randint(-1, vertices))] + [number() for _ in range(3)])
    wild = rng.random() < wildness
    if kind == "v": return rng.choice([f"{vertices}", "3-1", "list.txt", ""] if wild else ["boundary", "corners", "0", "0,1,2", "0-3"])
    if kind == "i": return rng.choice(NUMBERS[:5]) if wild else str(rng.randint(1, 3))
    if kind == "f": return rng.choice(["list.txt", "no.obj", "."]) if wild else "in.obj"
    if kind == "l": return rng.choice(["list.txt", "in.obj", "."]) if wild else "loads.csv"
    if kind == "e": return "behind" if wild else rng.choice(["iso", "top", "-10,200"])
    if kind == "h": return ",".join(number() for _ in range(rng.choice([2, 3])))
    if kind == "o": return "middle" if wild else rng.choice(["little", "big", "ascii"])
    if kind == "k": return "mauve" if wild else rng.choice(["planarity", "area", "parallelogram", "bend"])
    return number()


# What needs another option, which is mostly added.
NEEDS = {"circular": "--planar", "conical": "--planar", "gauss": "--planar", "colour": "--picture=out.svg", "view": "--picture=out.svg",
         "support": "--offset=0.2,panel.obj", "forces": "--equilibrium", "encoding": "--offset=0.2,panel.ply",
         "sheet": "--panels=out.dxf", "panel-scale": "--panels=out.dxf", "panel-list": "--panels=out.dxf"}
NEEDS.update({name: "--equilibrium" for name in ("compressive", "tensile", "stress", "supports", "density", "area-load", "snow", "loads",
                                                 "force-fairness")})


def arguments(rng, vertices):
    wildness = rng.choice([0, 0, 0.05, 0.3])
    args = ["in.obj", "-o", "out.obj"]
    if rng.random() < wildness / 2: args = rng.choice([["in.obj"], ["-o", "out.obj"], [], ["no.obj", "-o", "out.off"]])
    options = rng.sample(sorted(set(OPTIONS) - {"planar"} - (set() if wildness else {"frobnicate", "sides"})), rng.randint(0, 6))
    if rng.random() < 0.5: args.append("--planar")
    if "iterations" not in options: args += ["--iterations", str(rng.randint(1, 15))]
    for name in options:
        kind = rng.choice(OPTIONS[name])
        if kind == "-": args.append("--" + name)
        elif OPTIONS[name][0] == "-": args.append(f"--{name}={value(rng, kind, vertices, wildness)}")
        else: args += ["--" + name, value(rng, kind, vertices, wildness)]
    outputs = rng.sample(sorted(OUTPUTS), rng.choice([0, 0, 1, 2]))
    for name in outputs: args += ["--" + name, OUTPUTS[name]]
    for name in options + outputs:
        if name in NEEDS and NEEDS[name].split("=")[0] not in [a.split("=")[0] for a in args] and rng.random() >= wildness:
            args += NEEDS[name].replace("=", " ").split(" ")
    if rng.random() < wildness / 4: args += ["--fill", "in.obj"]
    return args


def limits():
    most = resource.getrlimit(resource.RLIMIT_CPU)[1]  # mutants.py sets one, which may be lowered only
    least = lambda seconds: seconds if most == resource.RLIM_INFINITY else min(seconds, most)
    resource.setrlimit(resource.RLIMIT_CPU, (least(60), least(70)))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(tool, folder, data, args):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for name, text in (("in.obj", data), ("list.txt", b"0 1\n2\n"), ("loads.csv", b"0,0,0,-1\n1,0.5,0,-1\n"), ("out.obj", b"before")):
        with open(os.path.join(folder, name), "wb") as file: file.write(text)
    process = subprocess.run([tool] + args, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, preexec_fn=limits)
    return process.returncode, process.stdout.decode(errors="replace"), process.stderr.decode(errors="replace")


def read(path):
    with open(path, "rb") as file: return file.read()


def wrong(folder, data, vertices, args, status, out, err):
    """What is wrong with the outcome; None: nothing."""
    if status not in (0, 1, 2, 3, 4): return f"status {status}"
    if "runtime error" in err or "Sanitizer" in err: return "a sanitizer's word"
    known = {"in.obj", "list.txt", "loads.csv", "out.obj", "panel.obj", "panel.ply", "out.off"} | set(OUTPUTS.values())
    strange = [name for name in os.listdir(folder) if name not in known]
    if strange: return f"{strange} left behind"
    if read(os.path.join(folder, "in.obj")) != data: return "the input was changed"
    after = read(os.path.join(folder, "out.obj"))
    if status >= 2:
        if not err.strip(): return "no sentence"
        if after != b"before": return "the output was touched"
        if any(os.path.exists(os.path.join(folder, name)) for name in list(OUTPUTS.values()) + ["panel.obj", "panel.ply"]): return "another output was made"
        return None
    if "-h" in args or "--help" in args or "--version" in args: return None
    lines = after.decode(errors="replace").split("\n")
    points = [line.split()[1:] for line in lines if line.startswith("v ")]
    if not all(len(p) == 3 and all(math.isfinite(float(x)) for x in p) for p in points): return "numbers that are not finite"
    changed = any(name in " ".join(args) for name in ("--weld", "--diagonals", "--subdivide", "--fill"))
    if not changed and not data.startswith(b"OFF") and len(points) != sum(l.startswith(b"v ") for l in data.split(b"\n")):
        return f"{len(points)} vertices"
    return None


def main():
    tool, first, count = os.path.abspath(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    seconds, begin = float(sys.argv[4]) if len(sys.argv) > 4 else 0, time.time()
    passed = failed = 0
    statuses = {}
    with tempfile.TemporaryDirectory() as folder:
        work, case = os.path.join(folder, "work"), first
        while case < first + count or time.time() < begin + seconds:
            rng = random.Random(case)
            data, vertices = grid(rng)
            args = arguments(rng, vertices)
            answer = run(tool, work, data, args)
            what = wrong(work, data, vertices, args, *answer)
            if not what and case % 8 == 0 and answer[0] < 2:
                bytes_now = read(os.path.join(work, "out.obj"))
                run(tool, work, data, args)
                if bytes_now != read(os.path.join(work, "out.obj")): what = "another result the second time"
            statuses[answer[0]] = statuses.get(answer[0], 0) + 1
            if what:
                print(f"FAILED: case {case}: {what}: {' '.join(args)}\n  {answer[2].strip()[:600]}")
            passed, failed, case = passed + (not what), failed + bool(what), case + 1
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print("cases by status:", dict(sorted(statuses.items())), f"{used.ru_utime + used.ru_stime:.0f} s of processor time")
    print(f"{passed} passed, {failed} failed")
    sys.exit(failed > 0)


main()
