#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Holds the modules against the floors of docs/architecture.md: a module depends on lower floors
# only, includes only from modules in its DEPENDS, and its headers show no library but Eigen and no
# type that another header has.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Lowest first. Modules in one line may not see each other.
floors=(
    "core"
    "geometry"
    "model"
    "io preprocessing"
    "registration structure"
    "interpretation evaluation simulation export"
    "pipeline reproduction"
    "report"
)
declare -A floor_of depends_of
for floor in "${!floors[@]}"; do
    for module in ${floors[floor]}; do floor_of[$module]=$floor; done
done

num_violations=0
violation() {
    printf '%s\n' "$*"
    num_violations=$((num_violations + 1))
}

# Prints the words between DEPENDS and the next keyword of the roomscribe_module() call in a file.
depends() {
    local keyword='' word
    for word in $(sed -n '/^roomscribe_module(/,/)/p' "$1" | tr '()' '  '); do
        case $word in
            DEPENDS | PUBLIC | PRIVATE) keyword=$word ;;
            *) [[ $keyword != DEPENDS ]] || printf '%s ' "$word" ;;
        esac
    done
}

for folder in src/roomscribe/*/; do
    module=$(basename "$folder")
    list=${folder}CMakeLists.txt
    [[ -n ${floor_of[$module]-} ]] || violation "$folder: the module has no floor"
    depends_of[$module]=" $(depends "$list")"
    for dependency in ${depends_of[$module]}; do
        ((${floor_of[$dependency]:-99} < ${floor_of[$module]:-99})) ||
            violation "$list: $module may not depend on $dependency, which is not on a lower floor"
    done
done

while IFS=: read -r file line text; do
    module=${file#src/roomscribe/}
    module=${module%%/*}
    included=${text#*\"}
    case $included in
        roomscribe/*/*)
            included=${included#roomscribe/}
            included=${included%%/*}
            [[ $included == "$module" || ${depends_of[$module]-} == *" $included "* ]] ||
                violation "$file:$line: $module includes from $included, which is not in its DEPENDS"
            ;;
        *) violation "$file:$line: not written as \"roomscribe/<module>/<file>\": ${included%\"*}" ;;
    esac
done < <(grep -rnE '^ *# *include +"' --include='*.[ch]pp' src/roomscribe)

# A standard header has neither a folder nor a suffix.
while IFS=: read -r file line text; do
    violation "$file:$line: a public header shows a library other than Eigen: $text"
done < <(grep -rnE '^ *# *include +<[^>]*[./]' --include='*.hpp' src/roomscribe | grep -v '<Eigen/')

# All modules share one namespace: two types of one name in it are undefined behaviour once linked.
while read -r type; do
    violation "$type is declared in two headers of src/roomscribe"
done < <(grep -rhoE '^(struct|class|enum class) [A-Z][[:alnum:]]*( :[^{]*)?( final)? \{' --include='*.hpp' src/roomscribe |
    sed -E 's/^(struct|enum class|class) ([[:alnum:]]+).*/\2/' | sort | uniq -d)

((num_violations == 0))
