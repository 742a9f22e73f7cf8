#!/usr/bin/env python3
"""corpus.py start|keep NAME - between corpus/NAME.hex, one input a line, and build/fuzz/fuzz_NAME.corpus, one file each.

start writes the files; keep replaces the lines by a small set of inputs that reaches all that the files reach (libFuzzer's
merge), those that were kept before first, the others by size, until there are KEPT bytes.
"""
import hashlib, os, subprocess, sys

KEPT = 12000
os.chdir(os.path.dirname(os.path.abspath(__file__)))
what, name = sys.argv[1:]
text, folder, program = f"corpus/{name}.hex", f"build/fuzz/fuzz_{name}.corpus", f"build/fuzz/fuzz_{name}"
os.makedirs(folder, exist_ok=True)
before = [bytes.fromhex(line) for line in open(text)] if os.path.exists(text) else []


def write(folder, inputs):
    for data in inputs:
        with open(os.path.join(folder, hashlib.sha1(data).hexdigest()), "wb") as file: file.write(data)


write(folder, before)
if what == "keep":
    merged = folder + ".merged"
    subprocess.run(["rm", "-rf", merged], check=True)
    os.makedirs(merged)
    # Twice: what was kept stays, and then what reaches more.
    subprocess.run([program, "-merge=1", "-verbosity=0", "-max_len=4096", merged, folder], check=True, stderr=subprocess.DEVNULL)
    found = sorted((open(os.path.join(merged, file), "rb").read() for file in os.listdir(merged)), key=lambda d: (len(d), d))
    kept, size = list(dict.fromkeys(before)), sum(len(data) for data in before)
    for data in found:
        if data in kept or size + len(data) > KEPT: continue
        kept.append(data)
        size += len(data)
    os.makedirs("corpus", exist_ok=True)
    with open(text, "w") as file: file.writelines(data.hex() + "\n" for data in kept)
    print(f"corpus: {name} has {len(kept)} inputs, {2 * size} digits")
