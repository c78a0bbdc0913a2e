#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs clang-tidy over the product's sources, in parallel. Nearly all of its time goes into the headers
# of the standard library and of Eigen, so it looks at several sources at once; those of a batch with a
# finding are looked at alone. A source that passed is not looked at again until it, a project header
# that it reaches, its compile command or .clang-tidy changes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=build/lint
passed=$build/tidy
batches=$build/tidy_batches
batch_size=8
rm -rf "$batches"
mkdir -p "$passed" "$batches"

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

declare -A stamp_of
for file in "${files[@]}"; do
    [[ $file == *.cpp ]] || continue
    key=$(print_inputs "$file" | sha256sum)
    stamp=$passed/${key%% *}
    [[ -f $stamp ]] || stamp_of[$file]=$stamp
done
printf '%d sources to look at\n' "${#stamp_of[@]}"
((${#stamp_of[@]})) || exit 0

# What a source is compiled with, and what it names at the outermost level: of two sources that share
# such a name, as anonymous namespaces may, only one goes into a batch.
declare -A command_of names_of
while IFS=$'\t' read -r file command; do command_of[$file]=$command; done < <(
    sed -nE "s|^ *\"command\": \"(.*) -o [^ ]+ -c $PWD/([^ ]+)\",\$|\2\t\1|p" $build/compile_commands.json)
while IFS=: read -r file name; do
    names_of[$file]+=" $name"
done < <(grep -HoP '^(?!namespace\b|using [\w:]+;)[A-Za-z][^({=;]*?\b\K\w+(?=\s*[({=;\[])' "${!stamp_of[@]}")

# Each batch is a source of its own, with the compile command of its members; locals of one may have
# names that others give to what is outermost.
num_batches=0
declare -a members command_of_batch size names
while IFS= read -r file; do
    for ((batch = 0; batch < num_batches; ++batch)); do
        [[ ${size[batch]} -lt $batch_size && ${command_of_batch[batch]} == "${command_of[$file]}" ]] || continue
        for name in ${names_of[$file]-}; do
            [[ " ${names[batch]} " != *" $name "* ]] || continue 2
        done
        break
    done
    if ((batch == num_batches)); then
        num_batches=$((num_batches + 1))
        command_of_batch[batch]=${command_of[$file]}
        size[batch]=0
        names[batch]=
        members[batch]=
    fi
    size[batch]=$((size[batch] + 1))
    names[batch]+=" ${names_of[$file]-}"
    members[batch]+=" $file"
    printf '#include "%s"\n' "$PWD/$file" >>"$batches/$batch.cpp"
done < <(printf '%s\n' "${!stamp_of[@]}" | LC_ALL=C sort)

{
    printf '['
    for ((batch = 0; batch < num_batches; ++batch)); do
        printf '%s\n{"directory": "%s", "file": "%s", "command": "%s -Wno-shadow -c %s"}' "${batch_comma-}" \
            "$PWD/$build" "$PWD/$batches/$batch.cpp" "${command_of_batch[batch]}" "$PWD/$batches/$batch.cpp"
        batch_comma=,
    done
    printf ']\n'
} >"$batches/compile_commands.json"

num_jobs=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
# shellcheck disable=SC2016
for ((batch = 0; batch < num_batches; ++batch)); do printf '%s\n' "$batch"; done |
    xargs -P "$num_jobs" -I{} bash -c \
        'clang-tidy-14 -p "$0" --quiet "$0/{}.cpp" >"$0/{}.log" 2>&1 && : >"$0/{}.passed" || :' "$batches"

todo=()
for ((batch = 0; batch < num_batches; ++batch)); do
    for file in ${members[batch]}; do
        if [[ -f $batches/$batch.passed ]]; then
            : >"${stamp_of[$file]}"
        else
            todo+=("$file" "${stamp_of[$file]}")
        fi
    done
done
((${#todo[@]})) || exit 0
printf '%d of them alone\n' $((${#todo[@]} / 2))

# shellcheck disable=SC2016
printf '%s\0' "${todo[@]}" | xargs -0 -n 2 -P "$num_jobs" bash -c '
    output=$(clang-tidy-14 -p "$0" --quiet "$1" 2>&1) && : >"$2" && exit
    grep -v " warnings generated\.$" <<<"$output"
    exit 1' "$build"
