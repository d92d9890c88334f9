#!/bin/sh
# Has the importer of Blender, where that is installed, read the files that validate.sh delivered to it:
# tests/extra/blender.sh FOLDER.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
command -v blender >/dev/null || {
    echo "skipped: blender is not here"
    exit 0
}
cd "$1/delivered"
blender --background --factory-startup --python-exit-code 1 --python "$here/blender.py" -- ./*-blender.glb
