#!/usr/bin/env python3
"""mutants.py [--number N] [--seed S] [--section NAMES] [--again] [--only NUMBERS] [--jobs J] [--sanitized]
[--report] - mutation testing of guidedproj.h.

Writes one copy of the header in which each of N small changes (mutants) can be chosen at run time (mutant schemata, Untch,
Offutt, Harrold 1993), compiles the test programs and the tool with it once, finds which test cases reach which mutant, and
runs these cases until one fails: short ones first, and those of the programs whose first lines name the mutant's section
(">>fill") before others that are a tenth as long. A mutant that no case notices has survived: a test is missing, or the
change makes no difference (then mutants.txt says why). One that takes much longer than the header without it is killed.

A mutant is chosen by the seed and its own text, so that most of those of a seed are the same when the header has changed.
Everything is in build/mutants: the copy of the project (tree), the list (mutants.json), one line a finished mutant
(results.jsonl). A run that is stopped goes on where it was, as long as header, seed, number and sections are the same;
--again tries survivors once more (after tests were added), --only 3,17 tries these, --jobs at a time (2). --sanitized tries
what survives with the sanitized programs as well, --report only adds up what was tried. The last lines add up by section; the
exit code is 0 whatever survives.
"""
import argparse, hashlib, json, multiprocessing, os, random, re, resource, signal, subprocess, sys, time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
WORK = os.path.join(HERE, "build", "mutants")
TREE = os.path.join(WORK, "tree")
CALL = "gprojt_is"  # the function that the copy asks whether a mutant is chosen

# ---- the header as tokens ----

TOKEN = re.compile(r"""(?P<space>\s+|/\*.*?\*/|//[^\n]*) | (?P<directive>^[ \t]*\#(?:\\\n|/\*.*?\*/|[^\n])*) |
    (?P<string>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*') | (?P<number>0[xX][0-9a-fA-F.]+(?:[pP][+-]?\d+)?[uUlLfF]*|
    (?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?[uUlLfF]*) | (?P<name>[A-Za-z_]\w*) |
    (?P<sign>\.\.\.|<<=|>>=|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|[-+*/%&|^~!<>=?:;,.(){}\[\]\#\\])""",
                   re.X | re.S | re.M)
BINARY = [["||"], ["&&"], ["|"], ["^"], ["&"], ["==", "!="], ["<", ">", "<=", ">="], ["<<", ">>"], ["+", "-"], ["*", "/", "%"]]
LEVEL = {sign: level for level, signs in enumerate(BINARY) for sign in signs}
ASSIGN = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}
TYPES = {"void", "char", "short", "int", "long", "float", "double", "signed", "unsigned", "bool", "size_t", "FILE", "const",
         "struct", "enum", "union", "static", "volatile", "va_list", "int8_t", "uint8_t", "int16_t", "uint16_t", "int32_t",
         "uint32_t", "int64_t", "uint64_t", "uintptr_t", "intptr_t", "ptrdiff_t", "lanes", "mode_t", "register"}
VARIADIC = {"gproji_format", "gproji_fail", "gproji_refuse", "gproji_stop"}
# What each sign becomes: (class, other sign).
CHANGES = {
    "<": [("boundary", "<="), ("negation", ">=")], "<=": [("boundary", "<"), ("negation", ">")],
    ">": [("boundary", ">="), ("negation", "<=")], ">=": [("boundary", ">"), ("negation", "<")],
    "==": [("negation", "!=")], "!=": [("negation", "==")], "&&": [("logic", "||")], "||": [("logic", "&&")],
    "+": [("arithmetic", "-")], "-": [("arithmetic", "+")], "*": [("arithmetic", "/")], "/": [("arithmetic", "*")],
    "%": [("arithmetic", "/")], "&": [("bits", "|")], "|": [("bits", "&")], "<<": [("bits", ">>")], ">>": [("bits", "<<")]}


class Cannot(Exception):
    """What the parser below does not know; the statement is left as it is."""


class Mutant:
    def __init__(self, kind, first, last, old, new, code):
        self.kind, self.first, self.last = kind, first, last  # tokens first..last-1 become `code`
        self.old, self.new, self.code = old, new, code


class Function:
    """Reads the statements of one function body and collects what can be changed; KEY in codes becomes the question."""

    def __init__(self, tokens, types, at, end, is_bool):
        self.tokens, self.types, self.at, self.end, self.is_bool = tokens, types, at, end, is_bool
        self.quiet, self.found = 0, []

    def text(self, first, last): return " ".join(t[1] for t in self.tokens[first:last])
    def see(self, ahead=0): return self.tokens[self.at + ahead][1]
    def kind(self, ahead=0): return self.tokens[self.at + ahead][0]

    def take(self, text=None):
        if text is not None and self.see() != text: raise Cannot(f"{text} wanted, {self.see()} found")
        self.at += 1
        return self.at - 1

    def skip_balanced(self):
        """From an opening bracket to behind the one that closes it."""
        depth = 0
        while True:
            depth += (self.see() in ("(", "[", "{")) - (self.see() in (")", "]", "}"))
            self.take()
            if depth == 0: return

    def offer(self, kind, first, last, new, code):
        if not self.quiet: self.found.append(Mutant(kind, first, last, self.text(first, last), new, code))

    # -- expressions: each returns the token it began at --

    def is_type(self, ahead=0): return self.kind(ahead) == "name" and self.see(ahead) in self.types

    def primary(self):
        begin = self.at
        if self.see() == "(":
            self.take()
            self.comma()
            self.take(")")
        elif self.kind() == "number":
            self.number(self.take())
        elif self.kind() == "string":
            while self.kind() == "string": self.take()
        elif self.kind() == "name":
            word = self.see()
            self.take()
            if word in ("true", "false"):
                other = "false" if word == "true" else "true"
                self.offer("truth", begin, self.at, other, f"(KEY ? {other} : {word})")
        else:
            raise Cannot(self.see())
        return begin

    def number(self, at):
        text = self.tokens[at][1]
        if re.fullmatch(r"(0[xX][0-9a-fA-F]+|\d+)[uUlL]*", text):
            self.offer("constant", at, at + 1, f"{text} + 1", f"(KEY ? {text} + 1 : {text})")
            if not re.fullmatch(r"0[uUlL]*", text):
                self.offer("constant", at, at + 1, f"{text} - 1", f"(KEY ? {text} - 1 : {text})")
        else:
            other = "1.0" if float.fromhex(text) == 0 else f"2 * {text}" if "x" in text.lower() else None
            other = other or ("1.0" if float(text.rstrip("fFlL")) == 0 else f"2 * {text}")
            self.offer("factor", at, at + 1, other, f"(KEY ? {other} : {text})")

    def arguments(self, function):
        """The arguments of a call; what macros do with theirs is not known."""
        macro = function.isupper() or function in ("va_arg", "va_start", "offsetof")
        self.quiet += macro
        ranges = []
        self.take("(")
        while self.see() != ")":
            begin = self.at
            self.assignment()
            ranges.append((begin, self.at))
            if self.see() == ",": self.take()
            elif self.see() != ")": raise Cannot(self.see())
        self.take(")")
        for (a, b), (c, d) in zip(ranges, ranges[1:]):
            one, two = self.text(a, b), self.text(c, d)
            if one != two and not (self.kind_of(a, b) == "string" or self.kind_of(c, d) == "string"):
                as_one, as_two = ((f"(__typeof__(({x}) + 0))({y})" for x, y in ((one, two), (two, one)))
                                  if function in VARIADIC else (two, one))  # there a ?: would decide about the type
                self.offer("swap", a, d, f"{two} , {one}", f"(KEY ? {as_one} : {one}), (KEY ? {as_two} : {two})")
        self.quiet -= macro

    def kind_of(self, first, last): return self.tokens[first][0] if last == first + 1 else "several"

    def postfix(self):
        begin = self.primary()
        while True:
            if self.see() == "(":
                self.arguments(self.tokens[begin][1] if self.at == begin + 1 else "")
            elif self.see() == "[":
                self.take()
                self.comma()
                self.take("]")
            elif self.see() in (".", "->"):
                self.take()
                self.take()
            elif self.see() in ("++", "--"):
                self.take()
            else:
                return begin

    def unary(self):
        begin, sign = self.at, self.see()
        if sign == "sizeof":
            self.quiet += 1
            self.take()
            if self.see() == "(" and self.is_type(1): self.skip_balanced()
            else: self.unary()
            self.quiet -= 1
        elif sign == "(" and self.is_type(1):
            self.skip_balanced()
            self.unary()
        elif sign in ("-", "!", "~", "*", "&", "+", "++", "--"):
            self.take()
            self.unary()
            operand = self.text(begin + 1, self.at)
            if sign == "-": self.offer("sign", begin, self.at, operand, f"(KEY ? {operand} : -{operand})")
            if sign == "!": self.offer("negation", begin, self.at, operand, f"(KEY == !!({operand}))")
        else:
            self.postfix()
        return begin

    def binary(self, level=0):
        if level == len(BINARY): return self.unary()
        begin = self.binary(level + 1)
        while self.see() in BINARY[level]:
            at = self.take()
            self.binary(level + 1)
            left, sign, right = self.text(begin, at), self.tokens[at][1], self.text(at + 1, self.at)
            for kind, other in CHANGES.get(sign, []):
                self.offer(kind, begin, self.at, f"{left} {other} {right}",
                           f"(KEY ? ({left}) {other} ({right}) : {left} {sign} {right})")
            if sign in ("&&", "||"):
                self.offer("operand", begin, self.at, left, f"(KEY ? !!({left}) : {left} {sign} {right})")
                self.offer("operand", begin, self.at, right, f"(KEY ? !!({right}) : {left} {sign} {right})")
        return begin

    def assignment(self):
        begin = self.binary()
        if self.see() == "?":
            self.negate(begin, self.at)
            self.take()
            self.comma()
            self.take(":")
            self.assignment()
        elif self.see() in ASSIGN:
            at = self.take()
            self.assignment()
            left, sign, right = self.text(begin, at), self.tokens[at][1], self.text(at + 1, self.at)
            other = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "|=": "&=", "&=": "|="}.get(sign)
            if other:
                self.offer("assign", begin, self.at, f"{left} {other} {right}",
                           f"(KEY ? ({left} {other} {right}) : ({left} {sign} {right}))")
        return begin

    def comma(self, deletable=False):
        """Parts with commas between; as a statement, each part may be left out."""
        begin, parts = self.at, 0
        while True:
            part = self.assignment()
            parts += 1
            text = self.text(part, self.at)
            whole = parts == 1 and self.see() == ";"
            if deletable and not whole and self.see() in (",", ";") and self.tokens[part][1] != "(":
                self.offer("delete", part, self.at, "", f"(KEY ? (void)0 : (void)({text}))")
            if self.see() != ",": return begin
            self.take()

    def negate(self, first, last):
        text = self.text(first, last)
        self.offer("condition", first, last, f"! ( {text} )", f"(KEY == !({text}))")

    # -- statements --

    def condition(self):
        self.take("(")
        begin = self.comma()
        self.negate(begin, self.at)
        self.take(")")

    def is_declaration(self):
        if self.is_type(): return self.see(1) != "("
        return self.kind() == "name" and self.kind(1) == "name"

    def declaration(self):
        static = False
        while self.kind() == "name" and (self.is_type() or self.kind(1) == "name" or self.see(1) == "*"):
            static |= self.see() == "static"
            self.take()
        self.quiet += static
        while True:
            while self.see() in ("*", "const", "GPROJI_RESTRICT"): self.take()
            if self.kind() != "name": raise Cannot(self.see())
            self.take()
            while self.see() == "[": self.skip_balanced()
            if self.see() == "=":
                self.take()
                if self.see() == "{": self.skip_balanced()
                else: self.assignment()
            if self.see() != ",": break
            self.take()
        self.quiet -= static
        self.take(";")

    def loop_header(self):
        self.take("(")
        if self.is_declaration(): self.declaration()
        elif self.see() == ";": self.take()
        else:
            self.comma(deletable=True)
            self.take(";")
        if self.see() != ";": self.comma()
        self.take(";")
        if self.see() != ")": self.comma()
        self.take(")")

    def jump(self):
        begin, word = self.at, self.see()
        self.take()
        if word == "goto": self.take()
        if self.see() != ";":
            value = self.comma()
            if word == "return" and self.is_bool and self.kind_of(value, self.at) == "several":
                text = self.text(value, self.at)
                self.offer("truth", value, self.at, f"! ( {text} )", f"(KEY == !({text}))")
        self.take(";")
        if not (self.see() == "}" and self.at >= self.end - 1):
            self.offer("jump", begin, self.at, "", f"{{ if (!KEY) {self.text(begin, self.at)} }}")

    def statement(self):
        begin, word = self.at, self.see()
        kept = len(self.found), self.quiet
        try:
            self.statement_of(begin, word)
        except (Cannot, IndexError, ValueError):
            del self.found[kept[0]:]
            self.quiet, self.at = kept[1], begin
            while self.see() not in (";", "{", "}"): self.take()
            if self.see() == "{": self.skip_balanced()
            elif self.see() == ";": self.take()
            elif self.at == begin: raise

    def statement_of(self, begin, word):
        if word == "{":
            self.take()
            while self.see() != "}": self.statement()
            self.take()
        elif word == ";":
            self.take()
        elif word in ("if", "while", "switch"):
            self.take()
            if word == "if": self.condition()
            else:
                self.take("(")
                self.comma()
                self.take(")")
            self.statement()
            if word == "if" and self.see() == "else":
                self.take()
                self.statement()
        elif word == "for":
            self.take()
            self.loop_header()
            self.statement()
        elif word == "do":
            self.take()
            self.statement()
            self.take("while")
            self.take("(")
            self.comma()
            self.take(")")
            self.take(";")
        elif word in ("case", "default"):
            while self.see() != ":": self.take()
            self.take()
        elif word in ("return", "break", "continue", "goto"):
            self.jump()
        elif self.kind() == "name" and self.see(1) == ":":
            self.at += 2
        elif self.is_declaration():
            self.declaration()
        else:
            self.comma(deletable=True)
            self.take(";")
            if not (word == "(" or word.isupper() or word.startswith("va_")):
                self.offer("delete", begin, self.at, "", f"{{ if (!KEY) {self.text(begin, self.at)} }}")


def read_tokens(source):
    tokens, at, line = [], 0, 1
    while at < len(source):
        found = TOKEN.match(source, at)
        if not found: sys.exit(f"mutants: cannot read line {line}: {source[at:at + 30]!r}")
        if found.lastgroup not in ("space", "directive"):
            tokens.append((found.lastgroup, found.group(), at, found.end(), line))
        line += found.group().count("\n")
        at = found.end()
    return tokens


def find_mutants(source):
    """All changes, each a dictionary with its place: section, function, line."""
    begin = source.index("#define GPROJI_IMPLEMENTED")
    line = source.count("\n", 0, begin)
    tokens = [(k, t, a + begin, b + begin, n + line) for k, t, a, b, n in read_tokens(source[begin:])]
    types = TYPES | set(re.findall(r"\}\s*(\w+);", source)) | set(re.findall(r"typedef [^;{]*?\(?\*?(\w+)\)?(?:\([^;]*\))?;", source))
    banners = [(source.count("\n", 0, m.start()) + 1, m.group(1))
               for m in re.finditer(r"={40,}\n   >>([a-z-]+)  ", source) if m.start() > begin]
    result, at = [], 0
    while at < len(tokens):
        if tokens[at][1] != "{":
            at += 1
            continue
        reader = Function(tokens, types, at, 0, False)
        reader.skip_balanced()
        end = reader.at
        if tokens[at - 1][1] == ")":
            name = open_of(tokens, at - 1) - 1
            reader = Function(tokens, types, at, end, tokens[name - 1][1] == "bool")
            reader.statement()
            section = [s for n, s in banners if n <= tokens[at][4]][-1]
            for m in reader.found:
                first, last = tokens[m.first][2], tokens[m.last - 1][3]
                if re.search(r"\n[ \t]*#", source[first:last]): continue
                result.append(dict(section=section, function=tokens[name][1], line=tokens[m.first][4], kind=m.kind,
                                   first=first, last=last, old=m.old, new=m.new, code=m.code))
        at = end
    return result


def open_of(tokens, at):
    depth = 0
    while True:
        depth += (tokens[at][1] == ")") - (tokens[at][1] == "(")
        if depth == 0: return at
        at -= 1


def compiled_lines():
    """The header's lines that this machine's compiler sees in the tests, behind #if."""
    run = subprocess.run(["cc", "-std=c11", "-pthread", "-E", "-I", ROOT, "-x", "c", "-"], capture_output=True, text=True,
                         input='#define GUIDEDPROJ_IMPLEMENTATION\n#include "guidedproj.h"\n')
    lines, inside, at = set(), False, 0
    for text in run.stdout.split("\n"):
        mark = re.match(r'# (\d+) "([^"]*)"', text)
        if mark: inside, at = mark.group(2).endswith("guidedproj.h"), int(mark.group(1))
        else:
            if inside and text.strip(): lines.add(at)
            at += 1
    return lines


def number_alike(mutants):
    """Tells apart those that make the same change in one function, so that a mutant has a name wherever its line moves."""
    seen = {}
    for m in sorted(mutants, key=lambda m: m["first"]):
        name = (m["function"], m["kind"], m["old"], m["new"])
        m["alike"] = seen[name] = seen.get(name, -1) + 1


def chance(seed, *names):
    """A number that seed and names decide, and nothing else in the header."""
    return hashlib.sha256(repr((seed, names)).encode()).hexdigest()


def choose(mutants, number, seed, sections):
    """A number for each section by its size, within it every class of changes in turn; one mutant a line, none in another.
    A change of the header leaves most of those chosen elsewhere as they are."""
    number_alike(mutants)
    by_section = {}
    for m in mutants:
        if not sections or m["section"] in sections: by_section.setdefault(m["section"], []).append(m)
    total = sum(len(ms) for ms in by_section.values())
    chosen = []
    for section, ms in by_section.items():
        quota = max(min(4, number), round(number * len(ms) / max(total, 1)))
        classes = {}
        for m in ms: classes.setdefault(m["kind"], []).append(m)
        lists = [classes[kind] for kind in sorted(classes, key=lambda kind: chance(seed, section, kind))]
        for group in lists: group.sort(key=lambda m: chance(seed, m["function"], m["kind"], m["old"], m["new"], m["alike"]))
        lines, taken = set(), []
        while lists and len(taken) < quota:
            group = lists.pop(0)
            m = group.pop()
            rows = range(m["line"], m["line"] + m["span"] + 1)
            if not lines.intersection(rows):
                lines.update(rows)
                taken.append(m)
            if group: lists.append(group)
        chosen += taken
    return sorted(chosen, key=lambda m: m["first"])


# ---- the copy of the project ----

PRELUDE = r"""#ifndef GPROJT_MUTANTS_H
#define GPROJT_MUTANTS_H
#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>
__attribute__((weak)) unsigned char gprojt_nowhere[%(size)d];
__attribute__((weak)) unsigned char *gprojt_reached = gprojt_nowhere;
__attribute__((weak)) int gprojt_mutant = -1;
/* The chosen mutant, and a file that is kept in memory for those reached, also by children and after a crash. */
__attribute__((weak, constructor)) void gprojt_mutants_start(void);
__attribute__((weak, constructor)) void gprojt_mutants_start(void) {
    const char *mutant = getenv("GPROJT_MUTANT"), *path = getenv("GPROJT_REACHED");
    int file = path ? open(path, O_RDWR) : -1;
    if (mutant) gprojt_mutant = atoi(mutant);
    if (file < 0) return;
    gprojt_reached = (unsigned char *)mmap(NULL, %(size)d, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (gprojt_reached == (unsigned char *)MAP_FAILED) gprojt_reached = gprojt_nowhere;
    close(file);
}
__attribute__((unused, always_inline)) static inline int gprojt_is(int mutant) {
    gprojt_reached[mutant] = 1;
    return gprojt_mutant == mutant;
}
#endif
"""


def write_header(source, mutants):
    """The header with all mutants, every line where it was."""
    parts, at = [], 0
    for number, m in enumerate(mutants):
        newlines = source.count("\n", m["first"], m["last"])
        parts += [source[at:m["first"]], m["code"].replace("KEY", f"{CALL}({number})"), "\n" * newlines]
        at = m["last"]
    text = "".join(parts) + source[at:]
    text = text.replace("#define GPROJI_IMPLEMENTED\n", '#define GPROJI_IMPLEMENTED //\n#include "mutants.h"\n#line %d\n' % (
        source.count("\n", 0, source.index("#define GPROJI_IMPLEMENTED")) + 2), 1)
    with open(os.path.join(TREE, "guidedproj.h"), "w") as f: f.write(text)
    for folder in TREE, os.path.join(TREE, "tests/build"):  # beside each copy of the header
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, "mutants.h"), "w") as f: f.write(PRELUDE % dict(size=len(mutants) + 1))


def make_tree():
    for folder in ("tests", "tools"):
        os.makedirs(os.path.join(TREE, folder), exist_ok=True)
        for name in os.listdir(os.path.join(ROOT, folder)):
            link = os.path.join(TREE, folder, name)
            if name != "build" and not os.path.lexists(link): os.symlink(os.path.join(ROOT, folder, name), link)
    for name in ("examples", "README.md", "LICENSE"):
        if not os.path.lexists(os.path.join(TREE, name)): os.symlink(os.path.join(ROOT, name), os.path.join(TREE, name))


def drop_those_that_do_not_compile(source, mutants):
    while True:
        write_header(source, mutants)
        bad = set()
        for files in ("0", "1"):
            run = subprocess.run(["cc", "-std=c11", "-pthread", "-fsyntax-only", "-I", TREE, "-DGPROJI_FILES=" + files,
                                  "-x", "c", "-"],
                                 input='#define GUIDEDPROJ_IMPLEMENTATION\n#include "guidedproj.h"\n', capture_output=True,
                                 text=True, cwd=TREE)
            bad |= {int(n) for n in re.findall(r"guidedproj\.h:(\d+):\d+: (?:warning|error)", run.stderr)}
        kept = [m for m in mutants if not bad.intersection(range(m["line"], m["line"] + m["span"] + 1))]
        if len(kept) == len(mutants):
            if run.returncode: sys.exit(run.stderr[:3000])
            return mutants
        mutants = kept


# ---- running ----

UNITS = []  # what measure returns, for the processes that try mutants


def limits(seconds):
    def set_limits():
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # a shell ignores it for what runs behind it
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
    return set_limits


def run_unit(unit, mutant=None, reached=None, seconds=3600, sanitized=False):
    """Runs a case of a program, or a script. Returns (went well, processor seconds, output)."""
    program, case = unit
    env = dict(os.environ, LC_ALL="C", ASAN_OPTIONS="allocator_may_return_null=1:detect_leaks=1")
    for name in ("GPROJT_ONLY", "GPROJT_MUTANT", "GPROJT_REACHED", "MAKEFLAGS"): env.pop(name, None)
    suffix = ".san" if sanitized else ""
    if case: env["GPROJT_ONLY"] = case
    if mutant is not None: env["GPROJT_MUTANT"] = str(mutant)
    if reached: env["GPROJT_REACHED"] = reached
    command = ["build/" + program + suffix]
    if program.endswith(".sh"):
        env["TOOL"] = env["GPROJ_TOOL"] = os.path.join(TREE, "tests/build/tool" + suffix)
        command = ["bash", program]
        if sanitized: env["GPROJT_SANITIZED"] = "1"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.Popen(command, cwd=os.path.join(TREE, "tests"), env=env, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=limits(seconds),
                               start_new_session=True)
    try:
        output = process.communicate(timeout=20 * seconds + 20)[0].decode(errors="replace")
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        output = process.communicate()[0].decode(errors="replace")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    well = process.returncode == 0 and re.search(r"(?m)^\d+ passed, 0 failed(, \d+ skipped)?$", output) is not None
    return well, used, output


def allowed(used, sanitized=False):
    """Seconds for a mutant where the header without one takes `used`, which is of programs without sanitizers."""
    return (20 if sanitized else 4) * used + 2


def measure_program(job):
    """(program, its cases: [case, processor seconds, mutants reached])"""
    program, count = job
    if program.endswith(".sh"): cases = [None]
    else:
        _, _, output = run_unit((program, None))
        cases = re.findall(r"(?m)^ok   (\w+)$", output)
        print("".join(f"mutants: {program} {case} fails without a mutant, left out\n"
                      for case in re.findall(r"(?m)^FAIL (\w+)", output)), end="", flush=True)
    reached, answer = os.path.join(WORK, f"reached.{program}"), []
    for case in cases:
        with open(reached, "wb") as f: f.write(bytes(count + 1))
        well, used, output = run_unit((program, case), reached=reached)
        # What does not bear the limits of a mutant would kill all of them.
        if well: well, _, output = run_unit((program, case), seconds=allowed(used))
        if not well:
            print(f"mutants: {program} {case or ''} fails without a mutant, left out:\n{output[-1000:]}", flush=True)
            continue
        with open(reached, "rb") as f: hits = f.read()
        answer.append([case, round(used, 4), [i for i in range(count) if hits[i]]])
    if cases: os.remove(reached)
    return program, answer


def named_sections(program):
    """The sections that the first lines of a test name: what it is about."""
    path = os.path.join(HERE, program + ("" if program.endswith(".sh") else ".c"))
    with open(path) as f: return set(re.findall(r">>([a-z-]+)", f.read(600)))


def measure(programs, count, jobs):
    """[(seconds, program, case, set of mutants, sections)], kept from run to run for programs that did not change."""
    path, todo, digests = os.path.join(WORK, "reach.json"), [], {}
    kept = json.load(open(path)) if os.path.exists(path) else {}
    for program in programs:
        file = os.path.join(TREE, "tests", "build/tool" if program.endswith(".sh") else "build/" + program)
        if not os.path.exists(file): sys.exit(f"mutants: {program} did not build")
        digest = hashlib.sha256(open(file, "rb").read())
        if program.endswith(".sh"): digest.update(open(os.path.join(HERE, program), "rb").read())
        digests[program] = digest.hexdigest()
        if kept.get(program, {}).get("digest") != digests[program]: todo.append((program, count))
    with multiprocessing.Pool(jobs) as pool:
        for program, cases in pool.imap_unordered(measure_program, todo):
            kept[program] = dict(digest=digests[program], cases=cases)
            with open(path, "w") as f: json.dump(kept, f)
    return [(used, program, case, set(hits), named_sections(program))
            for program in programs for case, used, hits in kept[program]["cases"]]


def try_mutant(job):
    """(number, verdict, the case that noticed, how many cases ran, seconds)"""
    number, section, sanitized = job
    ran, verdict, begin = 0, "unreached", time.time()
    mine = sorted((used * (0.1 if section in sections else 1), used, program, case)
                  for used, program, case, hits, sections in UNITS if number in hits)
    for san in [False, True] if sanitized else [False]:
        for _, used, program, case in mine:
            ran += 1
            well, _, _ = run_unit((program, case), mutant=number, seconds=allowed(used, san), sanitized=san)
            if not well: return number, "killed", f"{program} {case or ''}".strip(), ran, time.time() - begin
            verdict = "survived"
    return number, verdict, "", ran, time.time() - begin


def build(programs, sanitized, jobs):
    targets = ["build/" + p for p in programs if not p.endswith(".sh")] + ["build/tool"]
    targets += [t + ".san" for t in targets] if sanitized else []
    run = subprocess.run(["make", "-C", os.path.join(TREE, "tests"), "-s", "-k", f"-j{jobs}", "CFLAGS=-O1 -g0", "WARNINGS=-w"] + targets,
                         env={k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "TESTS", "TEST")})
    if run.returncode: sys.exit("mutants: the copy does not compile")


def read_equivalent():
    """mutants.txt: function | old | new | reason; or function | (kind) | * | reason, for numbers that are tuned. With `old @ text`
    only in lines with this text; a | of the code is written \\|. Returns the texts (without spaces; "": any line) for each
    function, old and new."""
    path, answer = os.path.join(HERE, "mutants.txt"), {}
    if os.path.exists(path):
        for line in open(path):
            parts = [p.strip().replace("\\|", "|") for p in line.split(" | ")]
            if len(parts) != 4 or line.startswith("#"): continue
            old, _, text = parts[1].partition(" @ ")
            answer.setdefault((parts[0], old, parts[2]), []).append("".join(text.split()))
    return answer


def one_line(m): return f"guidedproj.h:{m['line']}: {m['function']}: {m['kind']}: {m['old'][:100]} -> {m['new'][:100] or 'nothing'}"


def report(mutants, results):
    equivalent = read_equivalent()
    with open(os.path.join(ROOT, "guidedproj.h")) as f: lines = ["".join(line.split()) for line in f]
    rows, order = {}, []
    for m, r in zip(mutants, results):
        if r is None: continue
        verdict = r["verdict"]
        if verdict != "killed":
            texts = equivalent.get((m["function"], m["old"], m["new"] or "nothing"), [])
            if any(text in lines[m["line"] - 1] for text in texts): verdict = "equivalent"
            elif (m["function"], f"({m['kind']})", "*") in equivalent: verdict = "tuned"
        if verdict in ("survived", "unreached"): print(f"{verdict}: {m['number']}: {one_line(m)}")
        if m["section"] not in rows:
            rows[m["section"]] = {}
            order.append(m["section"])
        rows[m["section"]][verdict] = rows[m["section"]].get(verdict, 0) + 1
    names = ["killed", "survived", "unreached", "equivalent", "tuned"]
    total = {n: sum(row.get(n, 0) for row in rows.values()) for n in names}
    for section in order + ["all"]:
        row = rows.get(section, total)
        print(f"{section:14}" + "".join(f"{row.get(n, 0):5} {n}" for n in names))
    of = sum(total.values()) - total["equivalent"] - total["tuned"]
    print(f"mutants: {total['killed']} of {of} killed ({100 * total['killed'] / max(of, 1):.1f} %)")


def prepare(source, options):
    """The chosen mutants; those of the last run if it was asked for the same."""
    with open(os.path.abspath(__file__), "rb") as f:
        own = hashlib.sha256(re.search(b"# ---- the header as tokens.*?# ---- running", f.read(), re.S).group()).hexdigest()
    key = [hashlib.sha256(source.encode()).hexdigest(), own, options.number, options.seed, options.section]
    path = os.path.join(WORK, "mutants.json")
    if os.path.exists(path):
        old = json.load(open(path))
        if old["key"] == key: return old["mutants"]
    for name in ("results.jsonl", "reach.json"):
        if os.path.exists(os.path.join(WORK, name)): os.remove(os.path.join(WORK, name))
    mutants = find_mutants(source)
    compiled = compiled_lines()
    mutants = [m for m in mutants if m["line"] in compiled]
    for m in mutants: m["span"] = source.count("\n", m["first"], m["last"])
    print(f"mutants: {len(mutants)} possible")
    mutants = choose(mutants, options.number, options.seed, options.section.split(",") if options.section else None)
    mutants = drop_those_that_do_not_compile(source, mutants)
    for number, m in enumerate(mutants): m["number"] = number
    with open(path, "w") as f: json.dump(dict(key=key, mutants=mutants), f)
    return mutants


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--number", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--section", default="")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--sanitized", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--report", action="store_true")
    options = parser.parse_args()
    os.makedirs(WORK, exist_ok=True)
    make_tree()
    with open(os.path.join(ROOT, "guidedproj.h")) as f: source = f.read()
    mutants = prepare(source, options)
    results, path = [None] * len(mutants), os.path.join(WORK, "results.jsonl")
    if os.path.exists(path):
        for line in open(path):
            r = json.loads(line)
            results[r["number"]] = r
    if options.report: return report(mutants, results)
    programs = sorted(n[:-2] for n in os.listdir(HERE) if re.fullmatch(r"test_\w+\.c", n))
    programs += sorted(n for n in os.listdir(HERE) if re.fullmatch(r"test_\w+\.sh", n) and n != "test_web.sh")
    print(f"mutants: {len(mutants)} chosen; compiles", flush=True)
    build(programs, options.sanitized, options.jobs)
    global UNITS
    UNITS = measure(programs, len(mutants), options.jobs)
    only = {int(n) for n in options.only.split(",") if n}
    print(f"mutants: {len(UNITS)} cases, {sum(u[0] for u in UNITS):.0f} s of them", flush=True)
    # In the order of a shuffle, so that a run that is stopped tells of all sections.
    order = list(range(len(mutants)))
    random.Random(options.seed).shuffle(order)
    done = lambda r: r and not only and (r["verdict"] == "killed" or not options.again)
    todo = [(n, mutants[n]["section"], options.sanitized) for n in order if (not only or n in only) and not done(results[n])]
    with multiprocessing.Pool(options.jobs) as pool, open(path, "a") as f:
        for number, verdict, by, ran, seconds in pool.imap_unordered(try_mutant, todo):
            results[number] = dict(number=number, verdict=verdict, by=by, ran=ran)
            f.write(json.dumps(results[number]) + "\n")
            f.flush()
            print(f"{verdict} {number} ({by or ran}, {seconds:.1f} s): {one_line(mutants[number])}", flush=True)
    report(mutants, results)


main()
