// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include "core/upward.h"
#include "envmap/private.h"
