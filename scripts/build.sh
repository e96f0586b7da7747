#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Builds the given targets (all without one) in build/release.
set -eu
cd "$(dirname "$0")/.."
cmake --preset release -G Ninja
cmake --build build/release -- "$@"
