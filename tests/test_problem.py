"""test_problem.py SCHEMA - prints the sections of problem files that the schema has.

test_problem.py SCHEMA HELP SECTIONS - the schema has the options that --help shows, and its sections have the keys that the
tool says: a line for each, its name, those that are needed, | and the others."""
import json
import re
import sys

schema = json.load(open(sys.argv[1], encoding="utf-8"))
sections = {key for key, rule in schema["properties"].items() if rule.get("items", {}).get("type") == "object"}
if len(sys.argv) == 2:
    print(*sorted(sections))
    sys.exit()
shown = set(re.findall(r"^  (?:-\w, |    )--([a-z-]+)", open(sys.argv[2], encoding="utf-8").read(), re.M))
options = (shown - {"problem", "write-problem", "help", "version"}) | {"input"}
keys = set(schema["properties"]) - sections
if keys != options:
    sys.exit(f"the schema lacks {sorted(options - keys)}, and has {sorted(keys - options)} too many")
said = dict(line.split(" ", 1) for line in open(sys.argv[3], encoding="utf-8").read().splitlines())
for name in sorted(sections):
    rule = schema["properties"][name]["items"]
    if rule["additionalProperties"] or not set(rule["required"]) <= set(rule["properties"]):
        sys.exit(f"the schema's section {name} is not strict")
    needed, others = (set(part.split()) for part in said.get(name, "|").split("|"))
    if needed != set(rule["required"]) or needed | others != set(rule["properties"]):
        sys.exit(f"the schema's section {name} has other keys than the tool: {said.get(name)}")
