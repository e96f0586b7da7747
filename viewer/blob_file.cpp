// SPDX-License-Identifier: Apache-2.0
#include "viewer/blob_file.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "prt/ply_table.h"
#include "viewer/scene_file.h"

namespace airlight {

std::vector<GaussianBlob> read_blobs(const std::string& path, std::size_t max_memory) {
    const std::vector<std::string> names = {"x", "y", "z", "scale", "amplitude"};
    // Half of it for the blobs, which are as large as the columns that they come from.
    const auto columns = read_ply_table(path, names, "a file of blobs", max_memory / 2);
    const std::size_t count = columns[0].size();
    for (std::size_t c = 0; c < names.size(); ++c) {
        const double low = c < 3 ? -kLargestSceneLength : 0;
        const double high = c < 3 ? kLargestSceneLength : kLargestSceneNumber;
        for (std::size_t i = 0; i < count; ++i) {
            if (!(columns[c][i] >= low && columns[c][i] <= high)) {
                throw Error(ErrorCode::data,
                            fmt::format("{} of blob {} is {}, not in [{}, {}]", names[c], i,
                                        columns[c][i], low, high),
                            path);
            }
        }
    }
    std::vector<GaussianBlob> blobs(count);
    for (std::size_t i = 0; i < count; ++i) {
        blobs[i] = {{columns[0][i], columns[1][i], columns[2][i]}, columns[3][i], columns[4][i]};
    }
    return blobs;
}

}  // namespace airlight
