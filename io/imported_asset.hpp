// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "io/import.hpp"
#include "io/reader_process.hpp"

namespace sunder {

/// An asset on its way from the process that reads it.
void send_asset(const ImportedAsset& asset, AnswerWriter& out);
/// Throws as AnswerReader::fail unless indices and sizes fit together.
ImportedAsset receive_asset(AnswerReader& in);

}  // namespace sunder
