#!/usr/bin/env bash
# Checks that every C++ file is as clang-format leaves it. `tests/lint.sh tidy` runs clang-tidy as well: minutes.
# `tests/lint.sh fix` formats instead.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mode=${1:-format}

mapfile -t files < <(find backends examples sdk tests -name build -prune -o \( -name '*.cpp' -o -name '*.hpp' \) -print | sort)
[ ${#files[@]} -gt 0 ] || { echo "no C++ files are found" >&2; exit 1; }

if [ "$mode" = fix ]; then
  clang-format -i "${files[@]}"
  exit
fi
printf '%s\0' "${files[@]}" | xargs -0 -n 40 -P 2 clang-format --dry-run -Werror
if [ "$mode" = tidy ]; then
  [ -f build/release/compile_commands.json ] || { echo "build/release is not configured; run tests/run.sh first" >&2; exit 1; }
  mkdir -p build/tidy  # clang cannot read GCC's precompiled headers, nor all of its flags
  sed -E 's/ -Winvalid-pch| -include [^ ]*cmake_pch\.hxx| -fpch-preprocess| -Wno-restrict//g' build/release/compile_commands.json >build/tidy/compile_commands.json
  printf '%s\0' "${files[@]}" | grep -zE '^(sdk|backends)/.*\.cpp$' | xargs -0 -n 1 -P 2 clang-tidy -p build/tidy --quiet
fi
