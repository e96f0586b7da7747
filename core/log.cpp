// SPDX-License-Identifier: Apache-2.0
#include "core/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

namespace airlight {

void set_up_log(int verbosity) {
    auto logger = std::make_shared<spdlog::logger>(
        "airlight", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    logger->set_pattern("airlight: %l: %v");
    logger->set_level(verbosity < 0    ? spdlog::level::err
                      : verbosity == 0 ? spdlog::level::warn
                      : verbosity == 1 ? spdlog::level::info
                                       : spdlog::level::debug);
    logger->flush_on(spdlog::level::debug);
    spdlog::set_default_logger(std::move(logger));
}

}  // namespace airlight
