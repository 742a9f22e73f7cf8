"""test_problem.py SCHEMA HELP - the schema of problem files has the options that --help shows, and the sections it says."""
import json
import re
import sys

schema = json.load(open(sys.argv[1], encoding="utf-8"))
shown = set(re.findall(r"^  (?:-\w, |    )--([a-z-]+)", open(sys.argv[2], encoding="utf-8").read(), re.M))
options = (shown - {"problem", "write-problem", "help", "version"}) | {"input"}
sections = {key for key, rule in schema["properties"].items() if rule.get("items", {}).get("type") == "object"}
keys = set(schema["properties"]) - sections
if keys != options:
    sys.exit(f"the schema lacks {sorted(options - keys)}, and has {sorted(keys - options)} too many")
for name in sections:
    rule = schema["properties"][name]["items"]
    if rule["additionalProperties"] or not set(rule["required"]) <= set(rule["properties"]):
        sys.exit(f"the schema's section {name} is not strict")
