// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strict_json.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "io/printable.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

/// Reads the text and tells how far the parser has come: nlohmann's SAX events carry no position.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** furthest) : at_(at), furthest_(furthest) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    *furthest_ = ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) {
    return a.at_ == b.at_;
  }

 private:
  const char* at_;
  const char** furthest_;
};

/// Counts lines up to the last character the parser took. That one is left out: it is the last of
/// a token, or the one after a number, which may already be the line's end.
class LineCounter {
 public:
  explicit LineCounter(std::string_view text)
      : begin_(text.data()), counted_(text.data()), furthest_(text.data()) {}
  const char** furthest() { return &furthest_; }
  /// How many characters the parser has taken.
  std::size_t taken() const { return static_cast<std::size_t>(furthest_ - begin_); }
  std::uint32_t line() {
    for (; counted_ + 1 < furthest_; ++counted_) {
      const bool ends_line = *counted_ == '\n' || (*counted_ == '\r' && counted_[1] != '\n');
      lines_ += ends_line;
    }
    return lines_;
  }

 private:
  const char* begin_;
  const char* counted_;
  const char* furthest_;
  std::uint32_t lines_ = 1;
};

/// nlohmann's handler interface; grows the tree and refuses what the grammar allows but a scene
/// must not have.
class TreeBuilder {
 public:
  TreeBuilder(std::string_view text, const std::string& name, LineCounter& lines)
      : text_(text), name_(name), lines_(lines) {}
  JsonValue take() { return std::move(root_); }

  bool null() { return place({}); }
  bool boolean(bool value) { return place(JsonValue(value)); }
  bool number_integer(std::int64_t value) {
    return value < 0 ? place(JsonValue(value)) : number_unsigned(0);  // it calls -0 an integer
  }
  bool number_unsigned(std::uint64_t value) { return place(JsonValue(value)); }
  bool number_float(double value, const std::string& text);
  bool string(std::string& value);
  bool binary(std::vector<std::uint8_t>&) { return false; }  // no such thing in JSON text
  bool start_object(std::size_t) { return open(JsonValue::object()); }
  bool start_array(std::size_t) { return open(JsonValue::list()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& value);
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& fault);

 private:
  struct Level {
    JsonValue* container = nullptr;
    std::string key;                       ///< of the member being read
    std::unordered_set<std::string> keys;  ///< all so far; only ever asked, never listed
  };

  bool place(JsonValue value);
  bool open(JsonValue container);
  bool close();
  std::string pointer() const;
  [[noreturn]] void fail(const std::string& what) { fail_at(pointer(), what); }
  [[noreturn]] void fail_at(const std::string& pointer, const std::string& what);

  std::string_view text_;
  const std::string& name_;
  LineCounter& lines_;
  JsonValue root_;
  std::vector<Level> levels_;
  std::size_t values_ = 0;
};

void TreeBuilder::fail_at(const std::string& pointer, const std::string& what) {
  throw Error(ErrorCode::input, printable(name_, std::string::npos) + ':' +
                                    std::to_string(lines_.line()) + ": " +
                                    (pointer.empty() ? "" : pointer + ": ") + what);
}

std::string TreeBuilder::pointer() const {
  std::string path;
  for (const Level& level : levels_) {
    const JsonValue::List* items = level.container->items();
    // A list's open value is the one about to be added or, when a level follows, the last added.
    const bool is_last = &level == &levels_.back();
    path += items ? '/' + std::to_string(is_last ? items->size() : items->size() - 1)
                  : pointer_step(level.key);
  }
  return path;
}

bool TreeBuilder::place(JsonValue value) {
  if (++values_ > kMaxJsonValues) {
    fail_at("", "more than " + std::to_string(kMaxJsonValues) + " values, which is the limit");
  }
  value.line = lines_.line();
  if (levels_.empty()) {
    root_ = std::move(value);
  } else if (JsonValue::List* items = levels_.back().container->items()) {
    items->push_back(std::move(value));
  } else {
    levels_.back().container->members()->push_back({levels_.back().key, std::move(value)});
  }
  return true;
}

bool TreeBuilder::open(JsonValue container) {
  if (levels_.size() == kMaxJsonDepth) {
    fail_at("", "nested deeper than " + std::to_string(kMaxJsonDepth) + " levels");
  }
  place(std::move(container));
  Level level;
  if (levels_.empty()) {
    level.container = &root_;
  } else if (JsonValue::List* items = levels_.back().container->items()) {
    level.container = &items->back();
  } else {
    level.container = &levels_.back().container->members()->back().value;
  }
  // Stays valid: the parent grows again only after this level is closed.
  levels_.push_back(std::move(level));
  return true;
}

bool TreeBuilder::close() {
  levels_.pop_back();
  return true;
}

bool TreeBuilder::key(std::string& value) {
  Level& level = levels_.back();
  level.key = value;
  if (value.find('\0') != std::string::npos) fail("a key with a NUL character in it");
  if (!level.keys.insert(value).second) {
    fail("the key \"" + printable(value, 40) + "\" occurs twice, give it once");
  }
  return true;
}

bool TreeBuilder::string(std::string& value) {
  if (value.find('\0') != std::string::npos) fail("a text with a NUL character in it");
  return place(JsonValue(std::move(value)));
}

bool TreeBuilder::number_float(double value, const std::string& text) {
  const std::string shown = printable(text, 40);
  if (text.find_first_of(".eE") == std::string::npos) {
    fail("the integer " + shown + " needs more than 64 bits");
  }
  const std::string digits = text.substr(0, text.find_first_of("eE"));
  if (value == 0 && digits.find_first_of("123456789") != std::string::npos) {
    fail("the number " + shown + " is too small to be told from 0, write 0");
  }
  return place(JsonValue(value + 0.0));
}

/// The word around the last character the parser took, at most 20 characters to either side.
std::string_view word_at(std::string_view text, std::size_t place) {
  constexpr std::string_view kEnds = " \t\r\n,:[]{}";
  constexpr std::size_t kReach = 20;
  const auto ends = [&](std::size_t i) { return kEnds.find(text[i]) != std::string_view::npos; };
  if (place >= text.size() || ends(place)) return {};
  std::size_t begin = place, end = place + 1;
  while (begin > 0 && place - begin < kReach && !ends(begin - 1)) --begin;
  while (end < text.size() && end - place < kReach && !ends(end)) ++end;
  return text.substr(begin, end - begin);
}

/// nlohmann's "[…] parse error at line 4, column 3: syntax error while parsing value - invalid
/// literal; last read: '…'" as "invalid literal, while reading value". Its position counts
/// differently, and what it quotes may be half the file.
std::string syntax_fault(std::string_view what) {
  constexpr std::string_view kWhile = "while parsing ", kReason = " - ", kQuote = "; last read: '";
  const std::size_t start = what.find(kWhile), reason = what.find(kReason, start);
  if (start == std::string_view::npos || reason == std::string_view::npos) return std::string(what);
  const std::string_view reading =
      what.substr(start + kWhile.size(), reason - start - kWhile.size());
  std::string fault(what.substr(reason + kReason.size()));
  const std::size_t quote = fault.find(kQuote);
  if (quote != std::string::npos) {
    const std::size_t end = fault.rfind('\'');
    fault.erase(quote, end < quote + kQuote.size() ? std::string::npos : end + 1 - quote);
  }
  return fault + ", while reading " + std::string(reading);
}

bool TreeBuilder::parse_error(std::size_t, const std::string& token,
                              const nlohmann::detail::exception& fault) {
  constexpr int kNumberOverflow = 406;
  if (fault.id == kNumberOverflow) {
    fail("the number " + printable(token, 40) + " is too large for a double, at most 1.79e308");
  }
  const std::string_view word = word_at(text_, lines_.taken() - 1);
  fail_at("", "not JSON: " + printable(syntax_fault(fault.what()), 200) +
                  (word.empty() ? "" : ", at '" + printable(word) + '\''));
}

/// What a file is that cannot be JSON in UTF-8 at all; empty: it may be.
std::string foreign_encoding(std::string_view text) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return "the file is empty";
  const bool has_mark = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
  const bool has_nul = text.substr(0, 16).find('\0') != std::string_view::npos;
  if (has_mark || has_nul) return "the file is UTF-16 or binary, save it as UTF-8";
  return {};
}

[[noreturn]] void fail_file(const std::filesystem::path& path, const std::string& what) {
  throw Error(ErrorCode::input, printable(path.string(), std::string::npos) + ": " + what);
}

/// An open file that closes itself.
struct Descriptor {
  int number = -1;
  explicit Descriptor(int opened) : number(opened) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

}  // namespace

JsonValue parse_json(std::string_view text, const std::string& name) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::string foreign = foreign_encoding(text);
  if (!foreign.empty()) {
    throw Error(ErrorCode::input, printable(name, std::string::npos) + ":1: " + foreign);
  }
  LineCounter lines(text);
  TreeBuilder builder(text, name, lines);
  const CountingIterator begin(text.data(), lines.furthest());
  const CountingIterator end(text.data() + text.size(), lines.furthest());
  nlohmann::json::sax_parse(begin, end, &builder);
  return builder.take();
}

std::string read_text_file(const std::filesystem::path& path, std::size_t limit) {
  // Not to wait for a pipe's writer.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number < 0) fail_file(path, std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status = {};
  if (::fstat(file.number, &status) != 0) fail_file(path, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) fail_file(path, "is a folder, give a file");
  if (!S_ISREG(status.st_mode)) fail_file(path, "is a pipe or a device, give a regular file");
  std::string content;
  std::string block(std::size_t{1} << 16, '\0');
  while (true) {
    const ssize_t got = ::read(file.number, block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_file(path, std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) return content;
    content.append(block, 0, static_cast<std::size_t>(got));
    if (content.size() > limit) {
      fail_file(path, "is larger than " + std::to_string(limit) + " bytes, which is the limit");
    }
  }
}

}  // namespace sunder
