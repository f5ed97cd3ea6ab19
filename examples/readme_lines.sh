#!/usr/bin/env bash
# The C++ that the README shows is, line by line, what examples/ten_lines.cpp is built from.
# usage: readme_lines.sh README.md ten_lines.cpp
set -euo pipefail

shown=$(sed -n '/^```cpp$/,/^```$/p' "$1" | sed '1d;$d')
built=$(sed -n '/ten lines: begin/,/ten lines: end/p' "$2" | sed '1d;$d' | sed 's/^  //')
[ -n "$shown" ] || { echo "$1 shows no C++" >&2; exit 1; }
[ "$(wc -l <<<"$built")" -eq 10 ] || { echo "$2 has $(wc -l <<<"$built") lines between its marks; expected ten" >&2; exit 1; }
diff -u <(echo "$built") <(echo "$shown") || { echo "the README and $2 differ" >&2; exit 1; }
