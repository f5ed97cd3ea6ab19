#!/usr/bin/env bash
# tests/fuzz/run.sh [SECONDS [NAME…]]: builds the preset `fuzz` and runs each target so long (60 s), from the stored inputs
# and what earlier runs found (build/fuzz/corpus). What fails is left in build/fuzz/findings; the script then fails.
# RELIEVO_FUZZ_RUNS=N ends a target after N executions.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seconds=${1:-60}
shift || true
jobs=${RELIEVO_JOBS:-2}
build=build/fuzz
# Allocations are remembered by their innermost calls alone, and freed memory is kept for less long: a third quicker.
export ASAN_OPTIONS=malloc_context_size=4:quarantine_size_mb=32${ASAN_OPTIONS:+:$ASAN_OPTIONS}

[ -f $build/build.ninja ] || cmake --preset fuzz >/dev/null
ninja -C $build -j "$jobs" --quiet relievo_fuzz
mkdir -p $build/findings

names=("$@")
if [ ${#names[@]} -eq 0 ]; then
  for source in tests/fuzz/*_fuzz.cpp; do names+=("$(basename "$source" _fuzz.cpp)"); done
fi

failed=0
for name in "${names[@]}"; do
  found=$build/corpus/$name
  log=$build/fuzz_$name.log
  mkdir -p "$found"
  dictionary=tests/fuzz/dictionaries/$name.dict
  words=()
  [ -f "$dictionary" ] && words=(-dict="$dictionary")
  # The packaged compilers allocate for good; -timeout catches what hangs.
  # Without the entropic schedule: its book-keeping took a fifth of the time.
  if $build/bin/fuzz_"$name" -max_total_time="$seconds" -runs="${RELIEVO_FUZZ_RUNS:--1}" -timeout=10 -rss_limit_mb=2048 \
      -max_len=4096 -print_final_stats=1 -entropic=0 "${words[@]}" -artifact_prefix=$build/findings/"$name"- "$found" tests/fuzz/corpus/"$name" >"$log" 2>&1; then
    result=ok
  else
    result=FAILED
    failed=1
    tail -40 "$log" >&2
  fi
  awk -v name="$name" -v result=$result '
    /number_of_executed_units/ { runs = $2 } /average_exec_per_sec/ { rate = $2 } /peak_rss_mb/ { rss = $2 }
    / cov: / { for (i = 1; i < NF; i++) if ($i == "cov:") cov = $(i + 1) }
    END { printf "%-12s %-6s %10d runs %8d/s %8d edges %6d MB\n", name, result, runs, rate, cov, rss }' "$log"
done
exit $failed
