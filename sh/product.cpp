// SPDX-License-Identifier: Apache-2.0
#include "sh/product.h"

#include <cassert>
#include <string>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "sh/index.h"

namespace airlight {
namespace {

// One pair through doubles, by whatever multiplies one pair in double.
template <class T, class Multiply>
void by_pairs(int order, std::size_t count, std::size_t slot_stride, std::size_t vector_stride,
              const T* a, const T* b, T* out, const Multiply& multiply) {
    const std::size_t size = sh_count(order);
    std::vector<double> x(size), y(size), product(size);
    for (std::size_t v = 0; v < count; ++v) {
        for (std::size_t k = 0; k < size; ++k) {
            x[k] = a[k * slot_stride + v * vector_stride];
            y[k] = b[k * slot_stride + v * vector_stride];
        }
        multiply(x.data(), y.data(), product.data());
        for (std::size_t k = 0; k < size; ++k) {
            out[k * slot_stride + v * vector_stride] = static_cast<T>(product[k]);
        }
    }
}

}  // namespace

std::string_view sh_product_method_name(ShProductMethod method) {
    return kShProductMethods[static_cast<std::size_t>(method)].name;
}

std::optional<ShProductMethod> sh_product_method_from_name(std::string_view name) {
    for (const ShProductMethodInfo& info : kShProductMethods) {
        if (info.name == name) return info.method;
    }
    return std::nullopt;
}

ShProduct::ShProduct(int order)
    : ShProduct(order, 2 <= order && order <= detail::ProductTree<float>::kLast
                           ? ShProductMethod::tree
                           : ShProductMethod::rows) {}

ShProduct::ShProduct(int order, ShProductMethod method)
    : order_(order), method_(method), tables_(tables(order, method)) {}

ShProduct::Tables ShProduct::tables(int order, ShProductMethod method) {
    const bool tree = method == ShProductMethod::tree;
    const int first = tree ? detail::ProductTree<float>::kFirst : 1;
    const int last = tree ? detail::ProductTree<float>::kLast : 255;
    if (order < first || order > last) {
        throw Error(ErrorCode::usage, "products by " + std::string(sh_product_method_name(method)) +
                                          ": the order is " + std::to_string(order) +
                                          ", the limits are " + std::to_string(first) + " and " +
                                          std::to_string(last));
    }
    switch (method) {
        case ShProductMethod::sparse:
            return TripleProducts(order);
        case ShProductMethod::tree:
            return Tree{detail::ProductTree<float>(TripleProducts(order)),
                        detail::ProductRows<double>(order)};
        case ShProductMethod::rows:
            return Rows{detail::ProductRows<float>(order), detail::ProductRows<double>(order)};
        case ShProductMethod::grid:
            break;
    }
    return ShGrid(order, (3 * order - 1) / 2);
}

void ShProduct::multiply(std::size_t count, const double* a, const double* b, double* out) const {
    std::visit(
        [&](const auto& table) {
            using Table = std::decay_t<decltype(table)>;
            if constexpr (std::is_same_v<Table, Tree> || std::is_same_v<Table, Rows>) {
                detail::multiply_rows(table.in_double, count, a, b, out);
            } else {
                by_pairs(order_, count, 1, sh_count(order_), a, b, out,
                         [&](const double* x, const double* y, double* product) {
                             table.multiply(x, y, product);
                         });
            }
        },
        tables_);
}

void ShProduct::multiply(std::size_t count, const float* a, const float* b, float* out) const {
    if (const auto* tree = std::get_if<Tree>(&tables_)) {
        detail::multiply_tree(tree->in_float, count, a, b, out);
    } else if (const auto* rows = std::get_if<Rows>(&tables_)) {
        detail::multiply_rows(rows->in_float, count, a, b, out);
    } else if (const auto* grid = std::get_if<ShGrid>(&tables_)) {
        grid->multiply(count, a, b, out);
    } else {
        const auto& sparse = std::get<TripleProducts>(tables_);
        by_pairs(order_, count, 1, sh_count(order_), a, b, out,
                 [&](const double* x, const double* y, double* product) {
                     sparse.multiply(x, y, product);
                 });
    }
}

void ShProduct::multiply_planes(std::size_t count, std::size_t stride, const double* a,
                                const double* b, double* out) const {
    assert(stride >= count);
    std::visit(
        [&](const auto& table) {
            using Table = std::decay_t<decltype(table)>;
            if constexpr (std::is_same_v<Table, Tree> || std::is_same_v<Table, Rows>) {
                detail::multiply_rows(table.in_double, count, stride, a, b, out);
            } else {
                by_pairs(order_, count, stride, 1, a, b, out,
                         [&](const double* x, const double* y, double* product) {
                             table.multiply(x, y, product);
                         });
            }
        },
        tables_);
}

void ShProduct::multiply_planes(std::size_t count, std::size_t stride, const float* a,
                                const float* b, float* out) const {
    assert(stride >= count);
    if (const auto* tree = std::get_if<Tree>(&tables_)) {
        detail::multiply_tree(tree->in_float, count, stride, a, b, out);
    } else if (const auto* rows = std::get_if<Rows>(&tables_)) {
        detail::multiply_rows(rows->in_float, count, stride, a, b, out);
    } else {
        std::visit(
            [&](const auto& table) {
                using Table = std::decay_t<decltype(table)>;
                if constexpr (std::is_same_v<Table, TripleProducts> ||
                              std::is_same_v<Table, ShGrid>) {
                    by_pairs(order_, count, stride, 1, a, b, out,
                             [&](const double* x, const double* y, double* product) {
                                 table.multiply(x, y, product);
                             });
                }
            },
            tables_);
    }
}

}  // namespace airlight
