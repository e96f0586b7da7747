#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Installs, builds, and runs every test.
set -eu
cd "$(dirname "$0")/.."

scripts/install-packages.sh
scripts/build.sh
ctest --test-dir build/release --output-on-failure -j "$(nproc)"
