#!/bin/sh
# with_python.sh SCRIPT [ARGUMENT...]: runs it; where there is no Python its test is skipped, and
# says so.
command -v python3 >/dev/null || { echo "no python3 here: skipped"; exit 77; }
exec python3 "$@"
