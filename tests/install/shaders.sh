#!/usr/bin/env bash
# A project outside of ours builds archives with relievo_add_shaders, from the installed package: nothing is done when
# nothing changed, and an edited include compiles what it reaches and nothing else. By Ninja and by Make, in folders
# with spaces in their names.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(cd "${1:-$root/build/release}" && pwd)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "shader build test: $*" >&2; cat "$work/log" >&2 || true; exit 1; }

cmake --install "$build" --prefix "$work/the prefix" >/dev/null
export CCACHE_DISABLE=1 RELIEVO_CACHE_DIR=$work/unused

# Runs a build. What it printed is in the log.
run() { cmake --build "$tree" >"$work/log" 2>&1; }
# The summary of `relievo permute` in the log, for manifest archives of one run.
compiled() { sed -n 's|.* \([0-9]*\) compiled, .*|\1|p' "$work/log" | awk '{ sum += $1 } END { if (NR) print sum }'; }
expect_compiled() {
  run || fail "$1: the build fails"
  local count
  count=$(compiled)
  [ "${count:-none}" = "$2" ] || fail "$generator, $1: ${count:-none} were compiled, expected $2"
}
# Twice: what a rebuild leaves behind must not cause another.
expect_nothing_to_do() {
  for _ in 1 2; do
    run || fail "$1: the build fails"
    if grep -qE 'permute|Shaders of|up to date$|compiled' "$work/log" && ! grep -qE 'no work to do' "$work/log"; then
      fail "$generator, $1: something was done"
    fi
    [ "$generator" != Ninja ] || grep -q 'no work to do' "$work/log" || fail "$1: Ninja had work to do"
  done
}
# Files' times must differ for Make.
edit() { sleep 1.1; sed -i "$1" "$2"; }

for generator in Ninja 'Unix Makefiles'; do
  source="$work/a project for $generator"
  tree="$work/a build with $generator"
  cp -r "$here/shaders" "$source"
  cmake -S "$source" -B "$tree" -G "$generator" -DCMAKE_PREFIX_PATH="$work/the prefix" >"$work/log" 2>&1 || fail "does not configure"

  # The manifest: 2 techniques × 2 address modes; the list: 2 techniques of ours. Everything is new.
  expect_compiled "the first build" 6
  for archive in "$tree/app.shaders/sample.rla" "$tree/the archives/listed.rla"; do
    [ -f "$archive" ] || fail "$generator: $archive is not there"
  done
  (cd "$tree" && ./app) >"$work/log" 2>&1 || fail "$generator: the program does not find its shaders"
  expect_nothing_to_do "the second build"

  before=$(stat -c %Y%s "$tree/the archives/listed.rla")
  # An include of the technique `wavy`, not of `flat`: two of four.
  edit 's/0\.5/0.25/' "$source/my techniques/wavy/part.glsl"
  expect_compiled "an edited include" 2
  [ "$before" = "$(stat -c %Y%s "$tree/the archives/listed.rla")" ] || fail "the other archive was written"
  expect_nothing_to_do "after an edited include"

  # A touched file: looked at, and the archive keeps its time.
  before=$(stat -c %Y "$tree/app.shaders/sample.rla")
  edit '' "$source/my techniques/wavy/part.glsl"
  run || fail "a touched file: the build fails"
  grep -q 'is up to date' "$work/log" || fail "$generator: a touched file is not looked at"
  [ "$before" = "$(stat -c %Y "$tree/app.shaders/sample.rla")" ] || fail "$generator: a touched file wrote the archive"
  expect_nothing_to_do "after a touched file"

  # A file that nothing includes is nothing to do.
  edit '$a // more' "$source/my techniques/flat/notes.glsl"
  expect_nothing_to_do "an unused file"

  # A folder that came may hold a technique.
  sleep 1.1
  mkdir "$source/my techniques/later"
  expect_compiled "a new folder" 0
  expect_nothing_to_do "after a new folder"

  # Taken back: all from the cache.
  edit 's/0\.25/0.5/' "$source/my techniques/wavy/part.glsl"
  expect_compiled "an edit taken back" 0
  expect_nothing_to_do "after an edit taken back"

  # An error stops the build at the author's line, and the mended file builds.
  edit 's/0\.5/nothing/' "$source/my techniques/wavy/part.glsl"
  if run; then fail "$generator: a broken include builds"; fi
  grep -q 'part.glsl:3' "$work/log" || fail "$generator: the error does not name the line"
  edit 's/nothing/0.75/' "$source/my techniques/wavy/part.glsl"
  expect_compiled "a mended include" 2

  # The manifest: one address mode more.
  edit 's/"clamp"\]/"clamp", "mirror"]/' "$source/shaders/relievo.toml"
  expect_compiled "an edited manifest" 2
  expect_nothing_to_do "after an edited manifest"

  # Configuring again writes the generated manifest only when it changes.
  sleep 1.1
  cmake "$tree" >/dev/null
  expect_nothing_to_do "after configuring again"
  echo "$generator: rebuilt what was reached, and nothing when nothing was"
done

# What is asked for wrongly is said when configuring.
refused() {
  printf 'cmake_minimum_required(VERSION 3.25)\nproject(wrong LANGUAGES C)\nfind_package(relievo REQUIRED)\nrelievo_add_shaders(%s)\n' "$1" >"$work/wrong/CMakeLists.txt"
  if cmake -S "$work/wrong" -B "$work/wrong/build" -DCMAKE_PREFIX_PATH="$work/the prefix" >"$work/log" 2>&1; then fail "accepted: $1"; fi
  tr '\n' ' ' <"$work/log" | tr -s ' ' | grep -q "$2" || fail "does not say: $2"
}
mkdir "$work/wrong"
refused 's' 'MANIFEST, or TECHNIQUES and TARGETS are expected'
refused 's MANIFEST none.toml' 'does not exist'
refused 's MANIFEST a.toml TECHNIQUES relief' 'one of the two is expected'
refused 's TECHNIQUES relief TARGETS glsl-450 CACHE' 'CACHE has no value'
refused 's nonsense' 'is not an argument'
echo "refuses what is wrong"
