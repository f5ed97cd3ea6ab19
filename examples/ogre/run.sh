#!/usr/bin/env bash
# Runs a command on a display of its own, in memory: run.sh COMMAND [ARGUMENT…]. The X server picks a free number.
set -euo pipefail
numbers=$(mktemp -u)
mkfifo "$numbers"
exec 3<>"$numbers"
rm "$numbers"
Xvfb -displayfd 3 -screen 0 64x64x24 +extension GLX -nolisten tcp 2>/dev/null 3>&3 &
server=$!
trap 'kill "$server" 2>/dev/null || true; wait "$server" 2>/dev/null || true' EXIT
read -r -t 30 number <&3 || { echo "Xvfb does not start within 30 s" >&2; exit 1; }
DISPLAY=:$number "$@"
