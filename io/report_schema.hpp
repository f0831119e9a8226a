// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace sunder {

/// JSON Schema (draft-07) of what report_json writes, for fracture and check.
std::string report_schema();
/// JSON Schema (draft-07) of what impact_report_json writes.
std::string impact_report_schema();
/// JSON Schema (draft-07) of what collapse_report_json writes.
std::string collapse_report_schema();

}  // namespace sunder
