#!/bin/sh
# pack.sh [animeme_face.zip]: the add-on as a zip for Blender's Edit > Preferences > Add-ons >
# Install. The same sources give the same bytes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python3 - "$here/animeme_face" "${1:-animeme_face.zip}" <<'PACK'
import pathlib, sys, zipfile
folder, out = map(pathlib.Path, sys.argv[1:])
with zipfile.ZipFile(out, "w") as pack:
    for file in sorted(folder.glob("*.py")):
        entry = zipfile.ZipInfo(f"{folder.name}/{file.name}", (2020, 1, 1, 0, 0, 0))
        entry.external_attr = 0o644 << 16
        pack.writestr(entry, file.read_bytes(), zipfile.ZIP_DEFLATED)
PACK
