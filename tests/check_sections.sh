#!/bin/bash
# check_sections.sh - the header reads from top to bottom: cut at any section banner, what comes before compiles; tags
# are unique and the manual's contents name them all, in order; no static function is declared ahead; and the banner of
# each section of the implementation names the sections whose functions, types and constants it uses, and no others.
#
# A banner is a comment that begins with a line of - or = and goes on with >>tag. The manual is everything before the
# first banner; its table of contents are its lines that begin with >>tag.
. "$(dirname "$0")/checks.sh"

have python3 && have gcc || { skip 'sections: no python3 or no gcc'; report; }
cat >"$work/sections.py" <<'END'
import re, sys
path, out = sys.argv[1:]
text = open(path, encoding="utf-8").read()
banners = [(m.start(), m.group(1)) for m in re.finditer(r"^/\* [-=]{20,}\n[ \t]*>>([a-z0-9-]+)", text, re.M)]
tags = [tag for _, tag in banners]
manual = text[:banners[0][0]] if banners else text
contents = re.findall(r"^[ \t]*(?:/\*)?[ \t]*>>([a-z0-9-]+)", manual, re.M)

# What is wrong with the tags; a file for each kind of complaint.
def complain(kind, lines):
    open(f"{out}/{kind}.list", "w").write("".join(line + "\n" for line in lines))
complain("banners", [] if len(tags) >= 2 else ["no section banners found"])
complain("unique", sorted({tag for tag in tags if tags.count(tag) > 1}))
complain("contents", [] if contents == tags else
         [f"in the contents, without a section or out of order: {tag}" for tag in contents if tag not in tags] +
         [f"a section, but not in the contents: {tag}" for tag in tags if tag not in contents] +
         [f"contents: {' '.join(contents)}", f"sections: {' '.join(tags)}"])
complain("references", sorted({tag for tag in re.findall(r">>([a-z][a-z0-9-]*)\b", text) if tag not in tags}))

# Static functions declared ahead: code without comments, strings and directives, up to a ; where a { should be.
code = re.sub(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', lambda m: "\n" * m.group().count("\n"), text, flags=re.S)
code = re.sub(r"^[ \t]*#(?:\\\n|[^\n])*", "", code, flags=re.M)
ahead = re.findall(r"^(?:GPROJI_INTERNAL|GPROJI_INLINE|GPROJI_NOINLINE|static)\b[^;{}=]*?\)\s*;", code, re.M)
complain("ahead", [" ".join(a.split()) for a in ahead])

# What sections use: names that an earlier section defines at the beginning of a line (constants: indented by four).
DEFINED = (r"^(?:GPROJ\w*|static)\b[^=;(]*?\b(gproji?_\w+)\s*\(", r"^#define (GPROJI?_\w+)", r"^\} (gproji_\w+);",
           r"^    (GPROJI_[A-Z0-9_]+)(?: = [^;]*?)?(?:,|\n)", r"^static const [^=;]*?\b(gproji_\w+)")
begins = [position for position, tag in banners if not tag.startswith("api-")] + [len(text)]
names, home, wrong = [], {}, []
for tag, begin, end in zip([tag for tag in tags if not tag.startswith("api-")], begins, begins[1:]):
    banner, _, body = text[begin + 3:end].partition("*/")
    body = re.sub(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"', "", body, flags=re.S)
    words = banner.split("\n\n")[0].split("Uses ")
    stated = set(re.findall(r"[a-z-]+", re.sub(r"\(.*?\)", "", words[-1]))) if len(words) > 1 else set()
    used = {home[word] for word in re.findall(r"\bgproji?_\w+|\bGPROJI_\w+", body) if word in home}
    wrong += [f">>{tag} uses {other}" for other in names if other in used - stated]
    wrong += [f">>{tag} cannot use {other}" for other in tags if other in stated - set(names)]
    wrong += [f">>{tag} does not use {other}" for other in names if other in stated - used]
    names.append(tag)
    for pattern in DEFINED:
        for word in re.findall(pattern, body, re.M):
            home.setdefault(word, tag)
complain("uses", wrong if len(home) > 500 else ["the definitions were not found"])

# The prefixes, with open conditionals closed.
for position, tag in banners + [(len(text), "end")]:
    prefix = text[:position]
    directives = re.findall(r"^[ \t]*#[ \t]*(if|ifdef|ifndef|endif)\b", re.sub(r"/\*.*?\*/", "", prefix, flags=re.S), re.M)
    depth = sum(-1 if d == "endif" else 1 for d in directives)
    open(f"{out}/prefix_{tag}.c", "w").write(prefix + "\n#endif" * depth + "\nextern int the_end;\n")
END
python3 "$work/sections.py" "$root/guidedproj.h" "$work" || fail 'sections.py'
for kind in 'banners:section banners' 'unique:tags used twice' 'contents:the table of contents differs from the sections' \
    'references:>>tags that name no section' 'uses:what a section uses is not what its banner says' \
    'ahead:static functions declared ahead of their definition'; do
    clean "${kind#*:}" "$(cat "$work/${kind%%:*}.list")"
done
# tcc takes a twentieth of the time; check_compile.sh compiles the whole with SIMD.
if have tcc; then compiler='tcc -Wall -Werror -o prefix.o -c'; else compiler='gcc -std=c99 -fsyntax-only -Wall -Werror -Wno-unused'; fi
for prefix in "$work"/prefix_*.c; do
    tag=${prefix##*/prefix_} tag=${tag%.c}
    job "what comes before >>$tag does not compile" "$compiler -DGUIDEDPROJ_IMPLEMENTATION '$prefix'"
done
run_jobs

# The manual's table from the paper to the code names functions, examples and tests that exist.
table() { # table: FUNCTION EXAMPLE FILE TEST of each line
    sed -n '/^   FROM THE PAPER TO THE CODE/,/^   CONTENTS/p' "$root/guidedproj.h" |
        sed -nE 's/.* (gproj_[a-z_]+) +([a-z_]+|-) +([a-z_]+): ([a-z_0-9]+)$/\1 \2 \3 \4/p'
}
[ "$(table | wc -l)" -ge 25 ] && pass || fail 'the table from the paper to the code was not found'
clean 'names in the table from the paper to the code' "$(table | while read -r function example file test; do
    grep -q "^GPROJ_API.*\b$function(" "$root/guidedproj.h" || echo "no function $function"
    [ "$example" = - ] || grep -q "\b$function(" "$root/examples/$example.c" || echo "$function is not in $example.c"
    grep -q "^GPROJT_TEST($test)" "$root/tests/test_$file.c" || echo "no test $test in test_$file.c"
done)"
report
