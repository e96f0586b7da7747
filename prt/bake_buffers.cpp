// SPDX-License-Identifier: Apache-2.0
#include "prt/bake_buffers.h"

#include "core/error.h"

namespace airlight::detail {
namespace {

// Where rows of that kind go; null for those that the baker does not make.
float** place_of(PrtKind kind, BakeRows& rows) {
    switch (kind) {
        case PrtKind::visibility:
            return &rows.visibility;
        case PrtKind::transfer:
            return &rows.transfer;
        case PrtKind::unshadowed_transfer:
            return &rows.unshadowed_transfer;
        case PrtKind::ambient_occlusion:
            return &rows.ambient_occlusion;
        case PrtKind::bent_normal:
            return &rows.bent_normal;
        case PrtKind::visibility_error:
            return &rows.visibility_error;
        case PrtKind::transfer_error:
            return &rows.transfer_error;
        default:
            return nullptr;
    }
}

std::uint32_t** integer_place_of(PrtKind kind, BakeRows& rows) {
    switch (kind) {
        case PrtKind::ray_count:
            return &rows.ray_count;
        case PrtKind::blocked_count:
            return &rows.blocked_count;
        default:
            return nullptr;
    }
}

}  // namespace

BakeBuffers::BakeBuffers(const PrtHeader& part, std::size_t rows) : header_(&part) {
    values_.resize(part.tables.size());
    integers_.resize(part.tables.size());
    for (std::size_t t = 0; t < part.tables.size(); ++t) {
        const PrtTable& table = part.tables[t];
        const std::size_t count = rows * prt_components(table.kind, part.order);
        if (table.type == PrtType::uint32) {
            integers_[t].resize(count);
        } else {
            BakeRows none;
            if (place_of(table.kind, none) == nullptr) {
                throw Error(ErrorCode::usage, "a bake does not make " + prt_name(table.kind));
            }
            values_[t].resize(count);
        }
    }
}

BakeRows BakeBuffers::rows(std::size_t row) {
    BakeRows rows;
    for (std::size_t t = 0; t < header_->tables.size(); ++t) {
        const PrtKind kind = header_->tables[t].kind;
        const std::size_t at = row * prt_components(kind, header_->order);
        if (float** const place = place_of(kind, rows)) *place = values_[t].data() + at;
        if (std::uint32_t** const place = integer_place_of(kind, rows)) {
            *place = integers_[t].data() + at;
        }
    }
    return rows;
}

void BakeBuffers::name(std::size_t row, const BakeSegment& segment) {
    for (std::size_t t = 0; t < header_->tables.size(); ++t) {
        if (header_->tables[t].kind != PrtKind::vertex_index) continue;
        for (std::size_t i = 0; i < segment.count; ++i) {
            integers_[t][row + i] =
                static_cast<std::uint32_t>(segment.offset + segment.vertices[i]);
        }
    }
}

std::vector<PrtColumn> BakeBuffers::columns() const {
    std::vector<PrtColumn> columns;
    for (std::size_t t = 0; t < header_->tables.size(); ++t) {
        if (header_->tables[t].type == PrtType::uint32) {
            columns.emplace_back(integers_[t]);
        } else {
            columns.emplace_back(values_[t]);
        }
    }
    return columns;
}

}  // namespace airlight::detail
