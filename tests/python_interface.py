"""python_interface.py HEADER BINDING WORK [COMPILER...] - compares examples/python/guidedproj.py with the header.

Parses the public part of the header, asks C for the sizes and offsets of all its structs and the values of all its
enumerators, and prints each difference: a struct, field, enumerator, function or argument that is missing, superfluous or
of another size or type. Prints nothing but "compared N" where all is alike."""
import ctypes
import importlib.util
import re
import subprocess
import sys

header, binding, work, *compiler = sys.argv[1:]
spec = importlib.util.spec_from_file_location("guidedproj", binding)
guidedproj = importlib.util.module_from_spec(spec)
spec.loader.exec_module(guidedproj)
source = open(binding, encoding="utf-8").read()
text = open(header, encoding="utf-8").read().split("#ifdef GUIDEDPROJ_IMPLEMENTATION")[0]
text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
left_out = guidedproj.LEFT_OUT
kept = set(left_out)
compared = 0


def out(name):
    """Is this name left out, with a reason?"""
    beginning = next((start for start in left_out if name.startswith(start)), None)
    kept.discard(beginning)
    return beginning is not None


def same(what, here, there):
    global compared
    compared += 1
    if here != there:
        print(f"{what}: {here} in the binding, {there} in the header")


# ---- structs: fields in C's order, with their types ----

structs, enums, programs = {}, {}, []
for name, inside in re.findall(r"^typedef struct (gproj_\w+) \{(.*?)^\}", text, re.M | re.S):
    fields = re.findall(r"(\w+)(?:\[\w+\])*\s*(?:,|;)", re.sub(r"\(\*(\w+)\)\([^;]*\)", r"\1", inside))
    structs[name] = fields
    programs.append(f'printf("{name} %d\\n", (int)sizeof({name}));')
    programs += [f'printf("{name}.{field} %d %d\\n", (int)offsetof({name}, {field}), (int)sizeof((({name} *)0)->{field}));'
                 for field in fields]
for name, inside in re.findall(r"^(?:typedef )?enum ?(gproj_\w+)? \{(.*?)^\}", text, re.M | re.S):
    members = re.findall(r"\b(GPROJ_\w+)\b(?:\s*=[^,]*)?", inside)
    enums[name] = [member for member in members if not member.endswith("FORCE_INT")]
    programs += [f'printf("{member} %d\\n", (int){member});' for member in enums[name]]
    if name:
        programs.append(f'printf("{name} %d\\n", (int)sizeof({name}));')
    else:
        enums.pop(name)
        enums[None, members[0]] = members
if len(structs) < 25 or len(enums) < 10:
    print(f"only {len(structs)} structs and {len(enums)} enumerations were found in the header")

with open(f"{work}/layout.c", "w", encoding="utf-8") as file:
    file.write('#include "guidedproj.h"\n#include <stdio.h>\nint main(void) {\n')
    file.write("\n".join(programs) + "\nreturn 0;\n}\n")
subprocess.run([*(compiler or ["cc"]), "-w", "-I", header.rsplit("/", 1)[0], f"{work}/layout.c", "-o", f"{work}/layout"],
               check=True)
printed = subprocess.run([f"{work}/layout"], check=True, capture_output=True, text=True).stdout
layout = {line.split()[0]: [int(number) for number in line.split()[1:]] for line in printed.split("\n") if line}

for name, fields in structs.items():
    if out(name):
        continue
    struct = guidedproj.STRUCTS.get(name)
    if struct is None:
        print(f"{name}: the binding has no such struct")
        continue
    same(name, [ctypes.sizeof(struct)], layout[name])
    same(f"fields of {name}", [field for field, _ in struct._fields_], fields)
    for field, kind in struct._fields_:
        if field in fields:
            same(f"{name}.{field}", [getattr(struct, field).offset, ctypes.sizeof(kind)], layout[f"{name}.{field}"])
for name in guidedproj.STRUCTS.keys() - structs.keys():
    print(f"{name}: the header has no such struct")

# ---- the types of fields: enumerations, structs, signs and floats, which sizes do not tell ----

simple = {"int32_t": "int32", "int64_t": "int64", "uint64_t": "uint64", "size_t": "size", "void": "void", "bool": "bool",
          "double": "double"}
callbacks = re.findall(r"\(\*(gproj_\w+)\)", text)


def type_of(declared):
    """The binding's word for a type in C."""
    declared = re.sub(r"\bconst\b", "", declared).strip()
    if "*" in declared or declared in callbacks:
        return "pointer"
    return simple.get(declared) or declared.replace("gproj_", "")


for name, inside in re.findall(r"^typedef struct (gproj_\w+) \{(.*?)^\}", text, re.M | re.S):
    if out(name):
        continue
    of = dict(guidedproj.STRUCTS[name]._fields_)
    for declared, names in re.findall(r"^\s*((?:const )?\w+(?: \*|\b)) ?([^;(]*);", inside, re.M):
        for field in re.findall(r"(\w+)(?:\[\w+\])?(?:,|$)", names.strip()):
            kind = of.get(field)
            if kind is None or declared.strip() in ("const char *", "char"):
                continue
            kind = getattr(kind, "_type_", kind) if isinstance(kind, type(ctypes.Array)) and "[" in names else kind
            same(f"type of {name}.{field}", kind, guidedproj._TYPES[type_of(declared)])

# ---- enumerations ----

for name, members in enums.items():
    if name in guidedproj.ENUMS:
        enum = guidedproj.ENUMS[name]
        same(name, {enum.prefix + member.name: member.value for member in enum},
             {member: layout[member][0] for member in members})
        same(f"size of {name}", [ctypes.sizeof(guidedproj._TYPES[name.replace("gproj_", "")])], layout[name])
    elif isinstance(name, tuple):
        for member in members:
            constant = member.replace("GPROJ_", "")
            if constant != "NUMBER_SIZE":  # of gproj_number_, which is left out
                same(member, getattr(guidedproj, constant, None), layout[member][0])
    elif not out(name):
        print(f"{name}: the binding has no such enumeration")
for name in guidedproj.ENUMS.keys() - enums.keys():
    print(f"{name}: the header has no such enumeration")

# ---- functions: result and arguments; and each is called somewhere ----

found = {}
for result, name, inside in re.findall(r"^GPROJ_API\s+([\w \*]+?)\b(gproj_\w+)\(([^;]*?)\);", text, re.M | re.S):
    arguments = [] if inside.strip() == "void" else " ".join(inside.split()).split(", ")
    kinds = ["pointer" if "*" in one or "[" in one else type_of(one.rsplit(" ", 1)[0]) for one in arguments]
    plain = ["int32" if "gproj_" + kind in enums else kind for kind in [type_of(result), *kinds]]
    found[name] = ("string" if "char *" in result else plain[0], plain[1:])
for name, declared in found.items():
    if out(name):
        continue
    same(name, guidedproj.FUNCTIONS.get(name), declared)
    used = rf'\b{name}\b|_add\("{name[len("gproj_add_"):]}"|_change\("{name[len("gproj_edit_"):]}"'
    if not re.search(used, source):
        print(f"{name} is declared, but never called")
for name in guidedproj.FUNCTIONS.keys() - found.keys():
    print(f"{name}: the header has no such function")
for name in kept:
    print(f"{name} is left out, but the header has nothing of that name")
same("version", guidedproj.VERSION, re.search(r'#define GPROJ_VERSION "(.*)"', text).group(1))
print(f"compared {compared}")
