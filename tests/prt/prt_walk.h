// SPDX-License-Identifier: Apache-2.0
// Whatever the reader of .prt files takes, it takes within its promises.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/error.h"
#include "prt/part_set.h"
#include "prt/prt_prefix.h"
#include "prt/prt_reader.h"

namespace airlight {

/// Whatever is asked of the file, there is an answer or a sentence.
template <class Ask, class Fail>
bool ask_prt(const Ask& ask, const Fail& fail) {
    try {
        ask();
        return true;
    } catch (const Error& error) {
        const std::string words = error.what();
        if (words.empty() || words.find('\n') != std::string::npos) fail("no sentence");
        if (error.code() != ErrorCode::data && error.code() != ErrorCode::memory) fail("a code");
        return false;
    }
}

/// Reads all of a file in every way; false when it was refused. Calls fail() with a broken promise.
template <class Fail>
bool walk_prt(const std::string& path, std::size_t max_memory, const Fail& fail) {
    ask_prt([&] { look_into_unfinished(path, max_memory); }, fail);
    ask_prt([&] { detail::gather_parts({path}, max_memory); }, fail);
    return ask_prt(
        [&] {
            const PrtReader reader(path, max_memory);
            reader.verify();
            const PrtHeader& header = reader.header();
            const std::size_t rows = static_cast<std::size_t>(header.rows);
            for (const PrtTable& table : header.tables) {
                const std::size_t components = reader.components(table.kind);
                if (components == 0 || rows * components * 2 > reader.file_bytes()) {
                    fail("more rows than the file can hold");
                }
                if (table.type == PrtType::uint32) {
                    std::vector<std::uint32_t> numbers(rows * components);
                    reader.read(table.kind, 0, rows, numbers.data());
                    for (const std::uint32_t number : numbers) {
                        if (table.kind == PrtKind::vertex_index && number >= header.mesh_vertices) {
                            fail("a vertex beyond the mesh");
                        }
                    }
                    continue;
                }
                const std::vector<float> all = reader.read_all(table.kind);
                for (const float value : all) {
                    if (!std::isfinite(value)) fail("a value that is not finite");
                }
                std::vector<float> row(components);
                for (std::size_t r = 0; r < rows; r += 1 + rows / 16) {
                    reader.read(table.kind, r, 1, row.data());
                    for (std::size_t i = 0; i < components; ++i) {
                        if (row[i] != all[r * components + i]) fail("rows that differ");
                    }
                }
            }
        },
        fail);
}

}  // namespace airlight
