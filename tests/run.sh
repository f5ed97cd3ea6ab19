#!/usr/bin/env bash
# Installs what is missing, builds the release preset, and runs the formatting check and every test.
# RELIEVO_LONG=1 also runs the tests labelled `long`; RELIEVO_JOBS (default 2) says how many at once.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
jobs=${RELIEVO_JOBS:-2}
build=build/release
log=$build/test.log

phase() {
  local name=$1 started=$SECONDS
  shift
  echo "== $name"
  "$@"
  echo "   $((SECONDS - started)) s"
}

configure() { [ -f $build/build.ninja ] || cmake --preset release >/dev/null; }

run_tests() {
  local exclude=(-LE long)
  [ "${RELIEVO_LONG:-0}" = 1 ] && exclude=()
  if ctest --test-dir $build --output-on-failure -j "$jobs" "${exclude[@]}" >$log 2>&1; then
    grep -E 'tests passed|tests failed|sec\*proc' $log
  else
    grep -vE '(Passed +[0-9.]+ sec|^ +Start +[0-9]+:)' $log >&2
    return 1
  fi
  if grep -q 'No tests were found' $log; then
    echo "no tests were found" >&2
    return 1
  fi
}

phase "packages" bash tests/setup.sh
phase "format" bash tests/lint.sh
phase "configure" configure
phase "build" ninja -C $build -j "$jobs" --quiet
phase "test" run_tests
echo "all in $SECONDS s; every test's time is in $log"
