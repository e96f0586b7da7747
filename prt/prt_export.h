// SPDX-License-Identifier: Apache-2.0
// What a .prt file holds, in the formats of other programs (docs/PRT_FILES.md says what they get).
#pragma once

#include <string>

#include "prt/mesh.h"
#include "prt/prt_reader.h"

namespace airlight {

/// The rows of one table as NumPy's format 1.0: little-endian float32, or uint32 for a table of
/// integers, C order, shape (rows, numbers in a row). Memory: a block of rows. Throws Error as
/// PrtReader and AtomicFile do.
void write_prt_npy(const PrtReader& reader, PrtKind kind, const std::string& path,
                   bool force = false);

/// The mesh as a binary little-endian PLY whose vertices carry colours and a table. Throws Error
/// also when
///   usage  the file is a part, or has no ambient occlusion, transfer or visibility to colour with;
///   data   the mesh is not the one that the file is of.
/// `mesh_name` is what messages call the mesh.
void write_prt_ply(const PrtReader& reader, PrtKind kind, const Mesh& mesh,
                   const std::string& mesh_name, const std::string& path, bool force = false);

}  // namespace airlight
