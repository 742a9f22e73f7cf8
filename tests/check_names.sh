#!/bin/bash
# check_names.sh - every name that the header defines at file scope has its prefix (gproj_, gproji_, GPROJ_, GPROJI_), no
# name is reserved for the compiler, and nothing is called that a library should leave alone.
. "$(dirname "$0")/checks.sh"

have python3 && have gcc || { skip 'names: no python3 or no gcc'; report; }
cat >"$work/names.py" <<'END'
import re, subprocess, sys
path, out, root = sys.argv[1:]
text = open(path, encoding="utf-8").read()

def blank(match):  # keeps the line numbers
    return " " + "\n" * match.group().count("\n")
code = re.sub(r"/\*.*?\*/|//[^\n]*", blank, text, flags=re.S)
code = re.sub(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', '""', code)

def complain(kind, lines):
    open(f"{out}/{kind}.list", "w").write("".join(line + "\n" for line in sorted(set(lines))))

def uses(pattern):  # line numbers and names
    return [(code.count("\n", 0, m.start()) + 1, m.group()) for m in re.finditer(pattern, code)]

macros = re.findall(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", code, re.M)
complain("macros", [m for m in macros if not re.match(r"GPROJI?_|GUIDEDPROJ_(H|IMPLEMENTATION)$", m)])

# Reserved: _Upper and double underscores, but for what compilers predefine.
known = (r"__(cplusplus|GNUC(_MINOR)?__|clang(_major)?__|TINYC__|attribute__|has_(attribute|builtin|include)|builtin_\w+|"
         r"extension__|vector_size__|STDC_VERSION__|FAST_MATH__|(AVX|FMA|SSE|ARM_|wasm|aarch64|x86_64|i386)\w*|"
         r"OPTIMIZE__|SIZEOF_\w+__|BYTE_ORDER__|ORDER_\w+__|FILE__|LINE__|restrict(__)?|declspec|forceinline|m\d+\w*|"
         r"mmask\d+|get_cpuid(_count)?|asm__|volatile__|CYGWIN__|unix__|APPLE__|HAIKU__|wasi__|STRICT_ANSI__|stdcall)$|"
         r"_(MSC_VER|MSVC_LANG|WIN32|WIN64|Pragma|M_\w+|mm\w+|O_[A-Z]+|S_I[A-Z]+|SH_DENYNO)$")
complain("reserved", [f"line {line}: {name}" for line, name in uses(r"\b(?:_[A-Z]\w*|\w*__\w*)\b")
                      if not re.match(known, name)])
complain("calls", [f"line {line}: {name}" for line, name in uses(
    r"(?<![.>\w])(setlocale|localeconv|strto(d|f|ld)|ato[fil]|v?[fs]?n?printf|v?[fs]?scanf|f?putc|f?puts|putchar|perror|"
    r"_?alloca|_?exit|abort|s?rand|strtok|strcpy|strcat|getenv|system|signal|longjmp|setjmp|gets)(?=\s*\()|"
    r"\b(stdout|stderr|stdin|errno)\b")])

# File-scope names of the preprocessed header, by walking its tokens.
def names(switches):
    command = ["gcc", "-E", "-std=c99", "-DNDEBUG", "-DGUIDEDPROJ_IMPLEMENTATION", *switches, "-I", root, f"{out}/header.c"]
    inside, kept = False, []
    for line in subprocess.run(command, capture_output=True, text=True, check=True).stdout.split("\n"):
        marker = re.match(r'# \d+ "([^"]*)"', line)
        if marker: inside = marker.group(1).endswith("guidedproj.h")
        elif inside and not line.startswith("#"): kept.append(line)
    tokens = re.findall(r"[A-Za-z_]\w*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])+'|\.?\d(?:[\w.]|[eEpP][+-])*|\S", "\n".join(kept))
    tokens = [t for t in tokens]
    at, statement, found = 0, [], []
    def close(first):  # the index after the bracket that closes tokens[first]
        pairs, depth = {"{": "}", "(": ")", "[": "]"}, 0
        opening, closing = tokens[first], pairs[tokens[first]]
        while True:
            depth += (tokens[first] == opening) - (tokens[first] == closing)
            first += 1
            if depth == 0: return first
    while at < len(tokens):
        token = tokens[at]
        if token == "__attribute__":
            at = close(at + 1)
        elif token == "{":
            end, body = close(at), statement[-1:] == [")"]
            if "enum" in statement and not body and "=" not in statement:
                inner = tokens[at + 1:end - 1]
                found += [("constant", t) for i, t in enumerate(inner)
                          if re.match(r"[A-Za-z_]", t) and (i == 0 or inner[i - 1] == ",")]
            at = end
            if body:
                found += declared(statement)
                statement = []
            else: statement.append("{}")
        elif token == ";":
            found += declared(statement)
            statement = []
            at += 1
        elif token == "[":
            at = close(at)
        else:
            statement.append(token)
            at += 1
    return found

def declared(s):
    found = [("type", s[i + 1]) for i, t in enumerate(s[:-1]) if t in ("struct", "enum", "union") and s[i + 1] != "{}"]
    if not s: return []
    pointer = [s[i + 2] for i in range(len(s) - 2) if s[i] == "(" and s[i + 1] == "*"]
    if s[0] == "typedef": found.append(("type", pointer[0] if pointer else s[-1]))
    elif "=" in s: found.append(("object", s[s.index("=") - 1]))
    elif "(" in s: found.append(("function", s[s.index("(") - 1]))
    elif s[-1] != "{}" and not (s[0] in ("struct", "union", "enum") and len(s) == 2): found.append(("object", s[-1]))
    return found

# Functions of POSIX that strict C hides are declared once more.
posix = ["readlink", "fchmod", "fchown"]
found = set()
for switches in [], ["-DGPROJ_NO_SIMD"], ["-DGPROJ_STATIC", "-DGPROJ_NO_STDIO"]: found |= set(names(switches))
upper, lower = r"GPROJI?_", r"gproji?_"
complain("scope", [f"{kind} {name}" for kind, name in found
                   if not re.match(upper if kind == "constant" else lower, name) and name not in posix])
count = len([1 for kind, _ in found if kind == "function"])
print(f"{count} functions, {len([1 for kind, _ in found if kind == 'type'])} types, {len(set(macros))} macros")
complain("count", [] if count >= 10 and macros else ["hardly any names found: the check itself is at fault"])

# The switches a user can define: what is tested by the preprocessor, has the prefix and is not defined by the header.
tested = set(re.findall(r"\bGPROJ_\w+|\bGUIDEDPROJ_IMPLEMENTATION", "\n".join(re.findall(r"^[ \t]*#[ \t]*(?:if|ifdef|ifndef|elif)\b.*", code, re.M))))
hooks = {"GPROJ_ASSERT"}
switches = sorted(tested - hooks - set(macros))
print("switches:", " ".join(switches))
complain("switches", [" ".join(switches)] if len(switches) > 6 else [])
END
python3 "$work/names.py" "$root/guidedproj.h" "$work" "$root" || fail 'names.py'
for kind in 'count:names are found' 'macros:macros without a prefix' 'reserved:names reserved for the compiler' \
    'calls:calls and words that the header does without' 'scope:file-scope names without a prefix' \
    'switches:more than six switches'; do
    clean "${kind#*:}" "$(cat "$work/${kind%%:*}.list" 2>&1)"
done
report
