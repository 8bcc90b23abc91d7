"""Every JSON asset names a schema that exists, and keeps to it; so does the fabric it names. Every schema is one itself."""
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
    fabric = document.get("fabric")
    named = fabric.get("base") if isinstance(fabric, dict) else fabric
    if named:
        path = file.parent / named if named.endswith(".json") else file.parent.parent / "fabrics" / f"{named}.json"
        if not path.exists():
            failures.append(f"{file}: fabric: no file {path}")
    checked += 1
print(*failures, f"{checked} files checked", sep="\n")
sys.exit(bool(failures) or checked == 0)
