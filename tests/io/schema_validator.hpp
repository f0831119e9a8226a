// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

namespace sunder {

/// The part of JSON Schema draft-07 that our schemas use; throws at a keyword it does not know, so
/// that none goes unchecked.
class SchemaValidator {
 public:
  explicit SchemaValidator(const std::string& schema);
  ~SchemaValidator();
  bool accepts(const std::string& text) const;  ///< of a JSON document

 private:
  class Rules;
  std::unique_ptr<const Rules> rules_;
};

}  // namespace sunder
