#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/list_sources.sh '*.sh' | xargs -0 shellcheck dev .ci/run
