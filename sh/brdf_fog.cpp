// SPDX-License-Identifier: Apache-2.0
#include "sh/brdf_fog.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "core/checked.h"
#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "sh/brdf_bands.h"
#include "sh/index.h"
#include "sh/phase_psf.h"
#include "sh/sphere_map.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

constexpr int kOversampling = 4;
constexpr std::size_t kCellBlock = 4096;

double channel_value(const std::vector<double>& values, int channel) {
    return values.size() == 1 ? values[0] : values[static_cast<std::size_t>(channel)];
}

void check_options(const BrdfFogOptions& options) {
    const auto check = [](const std::vector<double>& values, double high, const char* what) {
        bool good = values.size() == 1 || values.size() == 3;
        for (const double v : values) good = good && v >= 0 && v <= high && std::isfinite(v);
        if (!good) {
            throw Error(ErrorCode::usage, fmt::format("{} takes one or three values of 0 and up{}",
                                                      what, high <= 1 ? " to 1" : ""));
        }
    };
    check(options.optical_thickness, HUGE_VAL, "the optical thickness");
    check(options.albedo, 1, "the albedo");
    const auto range = [](int value, int low, int high, const char* what) {
        if (value >= low && value <= high) return;
        throw Error(ErrorCode::usage,
                    fmt::format("{} must be in [{}, {}], got {}", what, low, high, value));
    };
    range(options.order, 1, kLargestBrdfOrder, "the order");
    range(options.outgoing, 4, 1024, "the number of outgoing angles");
}

// albedo T e^-T, by which the bands without it are scaled at the end, where nothing underflows.
double scattered_scale(const BrdfFogOptions& options, int channel) {
    if (options.component == BrdfComponent::direct) return 0;
    const double thickness = channel_value(options.optical_thickness, channel);
    return channel_value(options.albedo, channel) * thickness * std::exp(-thickness);
}

/// The outgoing angles with bands: even, the last a quarter of a step before the horizon.
class OutgoingNodes {
  public:
    explicit OutgoingNodes(int count) : count_(count), step_(kPi / 2 / (count - 0.75)) {}

    int count() const { return count_; }
    double angle(int node) const { return node * step_; }
    /// The first of the four nodes that interpolate at an angle.
    int first(double angle) const {
        return std::clamp(static_cast<int>(angle / step_) - 1, 0, count_ - 4);
    }
    /// The weight of node first + k.
    double weight(double angle, int node_first, int k) const {
        const double t = angle / step_ - node_first;
        switch (k) {
            case 0:
                return (t - 1) * (t - 2) * (3 - t) / 6;
            case 1:
                return t * (t - 2) * (t - 3) / 2;
            case 2:
                return t * (t - 1) * (3 - t) / 2;
            default:
                return t * (t - 1) * (t - 2) / 6;
        }
    }

  private:
    int count_;
    double step_;
};

/// The directions of all cells, from tables of one coordinate each.
class Cells {
  public:
    explicit Cells(const BrdfSize& size) : size_(size) {
        for (int i = 0; i < size.half; ++i) half_.push_back(turn(angles(i, 0, 0).theta_half));
        for (int i = 0; i < size.difference; ++i) {
            difference_.push_back(turn(angles(0, i, 0).theta_difference));
        }
        for (int i = 0; i < size.azimuth; ++i) {
            azimuth_.push_back(turn(angles(0, 0, i).phi_difference));
        }
    }

    struct Cell {
        glm::dvec3 half, in, out;
        bool above = false;  // both directions above the horizon
    };

    Cell operator()(std::size_t index) const {
        const auto azimuth = static_cast<std::size_t>(size_.azimuth);
        const auto difference = static_cast<std::size_t>(size_.difference);
        const Turn& h = half_[index / azimuth / difference];
        const Turn& d = difference_[index / azimuth % difference];
        const Turn& p = azimuth_[index % azimuth];
        Cell cell;
        cell.half = {h.sine, 0, h.cosine};
        const glm::dvec3 away =
            d.sine * glm::dvec3(p.cosine * h.cosine, p.sine, -p.cosine * h.sine);
        cell.in = d.cosine * cell.half + away;
        cell.out = d.cosine * cell.half - away;
        cell.above = cell.in.z > 1e-9 && cell.out.z > 1e-9;
        return cell;
    }

  private:
    struct Turn {
        double sine, cosine;
    };
    static Turn turn(double angle) { return {std::sin(angle), std::cos(angle)}; }
    BrdfAngles angles(int h, int d, int p) const { return brdf_cell_centre(size_, h, d, p); }

    BrdfSize size_;
    std::vector<Turn> half_, difference_, azimuth_;
};

double outgoing_angle(const Cells::Cell& cell) {
    return std::atan2(std::hypot(cell.out.x, cell.out.y), cell.out.z);
}

/// The indices of the cells above the horizon, sorted by the first node that they are interpolated
/// from: bucket b is [start[b], start[b + 1]).
struct Buckets {
    std::vector<std::uint32_t> cells;
    std::vector<std::size_t> start;
};

Buckets sort_cells(const Cells& cells, std::size_t count, const OutgoingNodes& nodes) {
    Buckets buckets;
    std::vector<std::int16_t> bucket(count);
    parallel_blocks(count, kCellBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Cells::Cell cell = cells(i);
            bucket[i] =
                static_cast<std::int16_t>(cell.above ? nodes.first(outgoing_angle(cell)) : -1);
        }
    });
    buckets.start.assign(static_cast<std::size_t>(nodes.count()) - 2, 0);
    for (const std::int16_t b : bucket) {
        if (b >= 0) ++buckets.start[static_cast<std::size_t>(b) + 1];
    }
    for (std::size_t b = 1; b < buckets.start.size(); ++b) buckets.start[b] += buckets.start[b - 1];
    buckets.cells.resize(buckets.start.back());
    std::vector<std::size_t> next = buckets.start;
    for (std::size_t i = 0; i < count; ++i) {
        if (bucket[i] >= 0) {
            buckets.cells[next[static_cast<std::size_t>(bucket[i])]++] =
                static_cast<std::uint32_t>(i);
        }
    }
    return buckets;
}

// Adds what the map of one node contributes to the cells of one bucket.
void add_node(const SphereMap& map, const OutgoingNodes& nodes, int node, int first,
              const Cells& cells, const std::uint32_t* begin, std::size_t count,
              std::vector<glm::dvec3>& sums) {
    const double angle = nodes.angle(node);
    const glm::dvec3 viewer(std::sin(angle), 0, std::cos(angle));
    parallel_blocks(count, kCellBlock, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            const Cells::Cell cell = cells(begin[i]);
            const double weight = nodes.weight(outgoing_angle(cell), first, node - first);
            // The half vector where `out` has the azimuth 0, and light mirrored about it.
            const double side = std::hypot(cell.out.x, cell.out.y);
            const double cosine = side > 0 ? cell.out.x / side : 1;
            const double sine = side > 0 ? cell.out.y / side : 0;
            const glm::dvec3 half(cell.half.x * cosine, -cell.half.x * sine, cell.half.z);
            const glm::dvec3 in = 2 * glm::dot(half, viewer) * half - viewer;
            sums[begin[i]] += weight * map(in);
        }
    });
}

double band_tail(const std::vector<double>& coefficients, int order) {
    const std::size_t count = sh_count(order), lower = sh_count((order + 1) / 2);
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        double all = 0, upper = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double value = coefficients[static_cast<std::size_t>(c) * count + i];
            all += value * value;
            if (i >= lower) upper += value * value;
        }
        if (all > 0) worst = std::max(worst, std::sqrt(upper / all));
    }
    return worst;
}

// E / (T e^-T) of all cells of a directed size.
std::vector<glm::dvec3> convolved(const BrdfTable& table, const BrdfSize& size,
                                  const BrdfFogOptions& options, BrdfFogReport& report,
                                  const std::function<void()>& tick) {
    const int order = options.order;
    std::vector<std::vector<double>> lambda;
    for (int c = 0; c < 3; ++c) {
        // The factored form is T e^-T e PSF_1, and e PSF_1 is what `scaled` means at T = 1.
        const double thickness =
            options.psf == PsfForm::factored ? 1 : channel_value(options.optical_thickness, c);
        lambda.push_back(psf_eigenvalues_scaled(thickness, options.phase, order));
    }
    const OutgoingNodes nodes(options.outgoing);
    const Cells cells(size);
    const Buckets buckets = sort_cells(cells, size.cells(), nodes);
    const BrdfBands bands(order);
    SphereMap map(order, kOversampling * std::max(order, 8));
    std::vector<glm::dvec3> sums(size.cells(), glm::dvec3(0.0));
    const std::size_t count = sh_count(order);
    std::vector<double> coefficients(3 * count);
    for (int node = 0; node < nodes.count(); ++node) {
        bands.coefficients(table, nodes.angle(node), coefficients.data());
        for (std::size_t c = 0; c < 3; ++c) {
            zonal_convolve(lambda[c], 1, coefficients.data() + c * count);
        }
        report.tail = std::max(report.tail, band_tail(coefficients, order));
        map.fill(coefficients.data());
        for (int first = std::max(0, node - 3); first <= std::min(node, nodes.count() - 4);
             ++first) {
            const std::size_t begin = buckets.start[static_cast<std::size_t>(first)];
            const std::size_t end = buckets.start[static_cast<std::size_t>(first) + 1];
            add_node(map, nodes, node, first, cells, buckets.cells.data() + begin, end - begin,
                     sums);
        }
        if (tick) tick();
    }
    return sums;
}

BrdfSize directed_size(BrdfSize size) {
    size.azimuth = 4 * size.difference;
    return size;
}

BrdfTable scaled_copy(const BrdfTable& table, const BrdfFogOptions& options, bool directed) {
    BrdfTable result(directed ? directed_size(table.size) : table.size);
    const auto from = static_cast<std::size_t>(table.size.azimuth);
    const auto to = static_cast<std::size_t>(result.size.azimuth);
    const std::size_t rows = table.values.size() / from;
    for (std::size_t row = 0; row < rows; ++row) {
        const auto channel = static_cast<int>(row / (rows / 3));
        const double scale = std::exp(-channel_value(options.optical_thickness, channel));
        for (std::size_t k = 0; k < to; ++k) {
            const double value = table.values[row * from + k % from];
            result.values[row * to + k] = value < 0 ? value : scale * value;
        }
    }
    return result;
}

// The scattered part in the units of the table, cell by cell, channel by channel; undershoots
// become 0.
std::vector<double> scattered_part(const std::vector<glm::dvec3>& sums, const BrdfSize& size,
                                   const BrdfFogOptions& options, BrdfFogReport& report) {
    const Cells cells(size);
    glm::dvec3 largest(0.0), deepest(0.0);
    for (const glm::dvec3& sum : sums) {
        largest = glm::max(largest, sum);
        deepest = glm::min(deepest, sum);
        report.undershoots += (sum.x < 0) + (sum.y < 0) + (sum.z < 0);
    }
    for (int c = 0; c < 3; ++c) {
        if (largest[c] > 0) report.deepest = std::max(report.deepest, -deepest[c] / largest[c]);
    }
    std::vector<double> values(3 * size.cells(), -1.0);
    parallel_blocks(size.cells(), kCellBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Cells::Cell cell = cells(i);
            if (!cell.above) continue;
            for (int c = 0; c < 3; ++c) {
                const auto channel = static_cast<std::size_t>(c);
                values[channel * size.cells() + i] = std::max(0.0, sums[i][c]) *
                                                     (scattered_scale(options, c) / cell.in.z) /
                                                     kBrdfScale[channel];
            }
        }
    });
    return values;
}

// Adds the parts where both are there, and measures how far they are from reciprocal.
double add_direct(const BrdfTable& table, const BrdfSize& size, const BrdfFogOptions& options,
                  std::vector<double>& values) {
    const Cells cells(size);
    const auto azimuth = static_cast<std::size_t>(size.azimuth);
    if (options.component == BrdfComponent::total) {
        const BrdfTable direct = scaled_copy(table, options, true);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i] < 0) continue;
            values[i] = direct.values[i] < 0 ? -1 : values[i] + direct.values[i];
        }
    }
    double apart = 0, together = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t index = i % size.cells();
        if (index % azimuth >= azimuth / 2) continue;
        const double a = values[i], b = values[i + azimuth / 2];
        if (a < 0 || b < 0) continue;
        const Cells::Cell cell = cells(index);
        const double weight = cell.in.z * cell.out.z;
        apart += std::abs(a - b) * weight;
        together += (a + b) * weight;
    }
    return together > 0 ? apart / together : 0;
}

BrdfTable reciprocal_mean(const BrdfSize& size, const std::vector<double>& values) {
    BrdfSize half = size;
    half.azimuth /= 2;
    BrdfTable result(half);
    const auto azimuth = static_cast<std::size_t>(half.azimuth);
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        const double* pair = values.data() + i / azimuth * 2 * azimuth + i % azimuth;
        if (pair[0] >= 0 && pair[azimuth] >= 0) {
            result.values[i] = 0.5 * pair[0] + 0.5 * pair[azimuth];
        }
    }
    return result;
}

}  // namespace

std::size_t foggy_brdf_memory(const BrdfSize& size, const BrdfFogOptions& options) {
    const std::size_t cells = directed_size(size).cells();
    // Sums, values and the direct part of three channels each, indices and the result.
    const std::size_t tables = checked_multiply(cells, 4 * 3 * sizeof(double) + 8, "the BRDF");
    return checked_add(tables, SphereMap::memory(kOversampling * std::max(options.order, 8)),
                       "the BRDF");
}

BrdfTable foggy_brdf(const BrdfTable& table, const BrdfFogOptions& options, BrdfFogReport* report,
                     const std::function<void()>& tick) {
    check_options(options);
    BrdfFogReport figures;
    const bool directed = options.directed || table.size.directed();
    const bool scatters = scattered_scale(options, 0) > 0 || scattered_scale(options, 1) > 0 ||
                          scattered_scale(options, 2) > 0;
    BrdfTable result;
    if (!scatters && options.component != BrdfComponent::scattered) {
        result = scaled_copy(table, options, directed);
        for (int i = 0; tick && i < options.outgoing; ++i) tick();
    } else {
        const BrdfSize size = directed_size(table.size);
        if (size.cells() > UINT32_MAX) {
            throw Error(ErrorCode::data, "the table has more than 2^32 cells");
        }
        std::vector<double> values =
            scattered_part(convolved(table, size, options, figures, tick), size, options, figures);
        figures.asymmetry = add_direct(table, size, options, values);
        if (directed) {
            result.size = size;
            result.values = std::move(values);
        } else {
            result = reciprocal_mean(size, values);
        }
    }
    const auto infinite = std::count_if(result.values.begin(), result.values.end(),
                                        [](double value) { return !std::isfinite(value); });
    if (infinite > 0) {
        throw Error(ErrorCode::data,
                    fmt::format("{} values of the effective BRDF overflow", infinite));
    }
    if (report != nullptr) *report = figures;
    return result;
}

}  // namespace airlight
