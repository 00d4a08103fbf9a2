#!/bin/sh
# pack.sh [animeme_face.zip]: the add-on as a zip for Blender's Edit > Preferences > Add-ons > Install. The same
# sources give the same bytes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python3 - "$here/animeme_face" "${1:-animeme_face.zip}" <<'PACK'
import os, sys, zipfile
folder, out = sys.argv[1:]
with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as pack:
    for name in sorted(os.listdir(folder)):
        if name.endswith(".py"):
            entry = zipfile.ZipInfo("animeme_face/" + name, (2020, 1, 1, 0, 0, 0))
            entry.external_attr = 0o644 << 16
            with open(os.path.join(folder, name), "rb") as file:
                pack.writestr(entry, file.read(), zipfile.ZIP_DEFLATED)
PACK
