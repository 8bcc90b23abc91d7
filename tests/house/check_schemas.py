"""Every JSON asset names a schema that exists, and keeps to it; every schema is one itself."""
import json
import pathlib
import sys

import jsonschema

assets = pathlib.Path(sys.argv[1])
failures = []
checked = 0
for file in sorted(assets.rglob("*.json")):
    document = json.loads(file.read_text())
    if file.parent.name == "schema":
        jsonschema.Draft7Validator.check_schema(document)
        continue
    if file.name.endswith(".drape.json"):  # written by the program for itself
        continue
    if "$schema" not in document:
        failures.append(f"{file}: no $schema")
        continue
    schema = json.loads((file.parent / document["$schema"]).read_text())
    for error in jsonschema.Draft7Validator(schema).iter_errors(document):
        failures.append(f"{file}: {'/'.join(map(str, error.absolute_path))}: {error.message}")
    checked += 1
print(*failures, f"{checked} files checked", sep="\n")
sys.exit(bool(failures) or checked == 0)
