// SPDX-License-Identifier: Apache-2.0
#include "basis.h"

#include <OpenImageIO/imageio.h>
