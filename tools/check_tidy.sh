#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs clang-tidy over the product's sources, in parallel. A source that passed is not looked at
# again until it, a project header that it reaches, its compile command or .clang-tidy changes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=build/lint
passed=$build/tidy
mkdir -p "$passed"

mapfile -t files < <(find src cli -name '*.[ch]pp' | LC_ALL=C sort)
declare -A hash_of includes_of
while read -r hash file; do hash_of[$file]=$hash; done < <(sha256sum "${files[@]}")
while IFS=: read -r file included; do
    for path in "src/$included" "$included"; do
        [[ -z ${hash_of[$path]-} ]] || includes_of[$file]+=" $path"
    done
done < <(grep -HoP '^ *# *include +"\K[^"]+' "${files[@]}")

settings=$(cat .clang-tidy CMakePresets.json cmake/*.cmake <(clang-tidy-14 --version) | sha256sum)

# Prints what the verdict on a source depends on: the hashes of all project files that it reaches.
print_inputs() {
    local -A seen=()
    local -a pending=("$1")
    local file included
    while ((${#pending[@]})); do
        file=${pending[-1]}
        unset 'pending[-1]'
        [[ -z ${seen[$file]-} ]] || continue
        seen[$file]=1
        printf '%s %s\n' "${hash_of[$file]}" "$file"
        for included in ${includes_of[$file]-}; do pending+=("$included"); done
    done
    printf '%s\n' "$settings"
}

todo=()
for file in "${files[@]}"; do
    [[ $file == *.cpp ]] || continue
    key=$(print_inputs "$file" | sha256sum)
    stamp=$passed/${key%% *}
    [[ -f $stamp ]] || todo+=("$file" "$stamp")
done
printf '%d sources to look at\n' $((${#todo[@]} / 2))
((${#todo[@]})) || exit 0

# shellcheck disable=SC2016
printf '%s\0' "${todo[@]}" | xargs -0 -n 2 -P "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" bash -c '
    output=$(clang-tidy-14 -p "$0" --quiet "$1" 2>&1) && : >"$2" && exit
    grep -v " warnings generated\.$" <<<"$output"
    exit 1' "$build"
