#!/usr/bin/env bash
# Installs a built tree into a fresh prefix and builds the examples there, as users do: installed.sh BUILD EXAMPLE…
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
for example in "$@"; do
  [ -n "$example" ] || continue
  # A copy, so that nothing beside the example's own folder can be included.
  cp -r "$here/$example" "$work/$example"
  cmake -S "$work/$example" -B "$work/$example/build" -DCMAKE_PREFIX_PATH="$work/prefix" >/dev/null
  cmake --build "$work/$example/build" -j 2 >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  echo "$example builds against the installed package"
done
