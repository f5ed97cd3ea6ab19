#!/usr/bin/env bash
# Installs a built tree (default build/release) into a fresh prefix, moves the prefix to a folder with a space in its
# name, and builds and runs a consumer against it twice: found by CMake, and found by pkg-config.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(cd "${1:-$root/build/release}" && pwd)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "install test: $*" >&2; exit 1; }

cmake --install "$build" --prefix "$work/first" >/dev/null
prefix="$work/the prefix"
mv "$work/first" "$prefix"
library=$(find "$prefix" -name librelievo.so)
[ -n "$library" ] || fail "the library is not installed"
libdir=$(dirname "$library")

# A path of the build machine in an installed file breaks the package elsewhere.
for path in "$root" "$build" "$work/first"; do
  leak=$(grep -rlF --include='*.cmake' --include='*.pc' --include='*.hpp' --include='*.h' -- "$path" "$prefix" || true)
  [ -z "$leak" ] || fail "$path is named in $leak"
done
for header in "$root"/sdk/include/relievo/*.hpp; do
  [ -f "$prefix/include/relievo/$(basename "$header")" ] || fail "$(basename "$header") is not installed"
done
[ -f "$prefix/include/relievo.h" ] || fail "relievo.h is not installed"

# What the library was made of must not meet what a program links itself.
foreign=$(nm -D --defined-only "$library" | awk '$3 !~ /^_Z.*7relievo|^relievo_/ && shown++ < 5 { print $3 }')
[ -z "$foreign" ] || fail "the library shows names that are not its own: $foreign"

echo "found by CMake:"
cmake -S "$here" -B "$work/cmake" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$work/cmake" >/dev/null || cmake --build "$work/cmake"
"$work/cmake/consumer"

echo "found by pkg-config:"
export PKG_CONFIG_PATH=$libdir/pkgconfig
eval "flags=($(pkg-config --cflags --libs relievo))" # it escapes spaces for a shell
"${CXX:-c++}" -std=c++20 "$here/consumer.cpp" "${flags[@]}" -Wl,-rpath,"$libdir" -o "$work/consumer"
"$work/consumer"

echo "the installed program:"
[ -x "$prefix/bin/relievo" ] || fail "the program is not installed"
"$prefix/bin/relievo" list >/dev/null || fail "the installed program does not list its techniques"
echo "lists its techniques"
