#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# list_sources.sh [NAME_PATTERN...]: the project's own files whose names match (default: C++), each
# ended by a NUL, in a fixed order. Works without git, and leaves out what is built.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

(($#)) || set -- '*.cpp' '*.hpp'
names=()
for pattern; do names+=(-o -name "$pattern"); done
find . \( -name .git -o -name .cache -o -name node_modules -o -path ./out -o -path './build*' \
    -o -path ./roomscribe-demo \) -prune -o -type f \( "${names[@]:1}" \) -print0 | LC_ALL=C sort -z
