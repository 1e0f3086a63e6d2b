#include "cad/read/xml_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"

namespace bernal::cad {
namespace {

/// As quoted in errors.
std::string quoted(std::string_view text) {
  constexpr std::size_t most = 40;
  return fmt::format("\"{}{}\"", text.substr(0, most), text.size() > most ? "..." : "");
}

}  // namespace

/// Replaces prefixed names by names that do not depend on prefixes.
class XmlDocument::Names {
 public:
  Names(XmlDocument& document, std::initializer_list<Namespace> asked) : document_(document), asked_(asked) {
    declare(document.root(), 0);
    own_ = uri_of(prefix_of(document.root().name())).value_or("");
    std::size_t depth = 0;  // iterative, because documents may be nested deeper than the stack allows
    for (xml_node node = document.root(); !node.empty();) {
      if (node.type() == pugi::node_element) rename(node, depth);
      if (!node.first_child().empty()) {
        node = node.first_child();
        ++depth;
        continue;
      }
      for (; depth > 0 && node.next_sibling().empty(); --depth) node = node.parent();
      node = depth > 0 ? node.next_sibling() : xml_node();
    }
  }

 private:
  using xml_node = pugi::xml_node;
  struct Declared {
    std::string_view prefix, uri;
    std::size_t depth;
  };

  static std::string_view prefix_of(std::string_view name) {
    const std::size_t colon = name.find(':');
    return colon == name.npos ? std::string_view() : name.substr(0, colon);
  }

  void declare(xml_node node, std::size_t depth) {
    while (!declared_.empty() && declared_.back().depth >= depth) declared_.pop_back();
    for (const pugi::xml_attribute attribute : node.attributes()) {
      const std::string_view name = attribute.name();
      if (name == "xmlns" || name.starts_with("xmlns:"))
        declared_.push_back({name.substr(std::min<std::size_t>(6, name.size())), attribute.value(), depth});
    }
  }

  /// By the innermost declaration; absent if there is none.
  std::optional<std::string_view> uri_of(std::string_view prefix) const {
    for (std::size_t k = declared_.size(); k-- > 0;)
      if (declared_[k].prefix == prefix) return declared_[k].uri;
    return prefix.empty() ? std::optional<std::string_view>("") : std::nullopt;
  }

  /// Empty if the name does not change.
  std::string name_for(std::string_view written, xml_node at) {
    const std::string_view prefix = prefix_of(written);
    const std::string local(written.substr(prefix.empty() ? 0 : prefix.size() + 1));
    const auto uri = uri_of(prefix);
    if (!uri && document_.undeclared_.empty()) {
      document_.undeclared_ = prefix;
      document_.undeclared_at_ = at;
    }
    if (uri == own_) return prefix.empty() ? std::string() : local;
    for (const Namespace& asked : asked_)
      if (uri == asked.uri) return std::string(asked.name) + local;
    return prefix.empty() ? ":" + local : std::string();
  }

  void rename(xml_node node, std::size_t depth) {
    declare(node, depth);
    for (pugi::xml_attribute attribute : node.attributes()) {
      const std::string_view prefix = prefix_of(attribute.name());
      if (prefix.empty() || prefix == "xml" || prefix == "xmlns") continue;
      if (const std::string name = name_for(attribute.name(), node); !name.empty())
        attribute.set_name(name.c_str());
    }
    if (const std::string name = name_for(node.name(), node); !name.empty()) node.set_name(name.c_str());
  }

  XmlDocument& document_;
  std::initializer_list<Namespace> asked_;
  std::string_view own_;
  std::vector<Declared> declared_;  ///< the innermost last
};

XmlDocument::XmlDocument(std::string name, std::string text, std::initializer_list<Namespace> asked)
    : name_(std::move(name)), text_(std::move(text)) {
  const pugi::xml_parse_result parsed =
      document_.load_buffer(text_.data(), text_.size(), pugi::parse_default | pugi::parse_embed_pcdata);
  if (parsed.status == pugi::status_out_of_memory) throw std::bad_alloc();
  const bool empty = parsed.status == pugi::status_no_document_element;
  if (!parsed && !empty)
    refuse_at(static_cast<std::size_t>(parsed.offset),
              fmt::format("it is no well-formed XML or breaks off: {}", parsed.description()));
  if (root().empty()) refuse_at(0, "it holds no XML");
  Names(*this, asked);
}

std::string_view XmlDocument::namespace_of(std::string_view prefix) const {
  return root().attribute(("xmlns:" + std::string(prefix)).c_str()).value();
}

void XmlDocument::require_namespaces() const {
  if (!undeclared_.empty())
    refuse(undeclared_at_, fmt::format("the prefix \"{0}\" stands for no namespace: xmlns:{0} is missing",
                                       plain_text(undeclared_, 40)));
}

pugi::xml_node XmlDocument::only_child(pugi::xml_node node, std::string_view name) const {
  const pugi::xml_node first = child_of(node, name);
  for (pugi::xml_node next = first.next_sibling(); !next.empty(); next = next.next_sibling())
    if (is_named(next, name)) refuse(next, fmt::format("a second <{}> in one <{}>", name, node.name()));
  return first;
}

void XmlDocument::refuse_at(std::size_t offset, const std::string& what) const {
  std::string place = name_;
  // In UTF-16, offsets are not those of the text.
  if (text_.find('\0') == text_.npos) {
    const auto end = text_.begin() + std::ptrdiff_t(std::min(offset, text_.size()));
    const auto line = 1 + std::count(text_.begin(), end, '\n');
    place = name_.empty() ? fmt::format("line {}", line) : fmt::format("line {} of {}", line, name_);
  }
  throw Error(ErrorCode::bad_mesh, place.empty() ? what : fmt::format("{} ({})", what, place));
}

void XmlDocument::refuse(pugi::xml_node at, const std::string& what) const {
  refuse_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(at.offset_debug(), 0)), what);
}

void XmlDocument::refuse_number(std::string_view text, pugi::xml_node at, const std::string& what) const {
  refuse(at, fmt::format("{} is {}, no finite number", what, quoted(trimmed(text))));
}

void XmlDocument::refuse_index(std::string_view text, std::size_t count, pugi::xml_node at,
                               const std::string& what) const {
  refuse(at,
         fmt::format("{} names vertex {}, and there are {}, from 0 on", what, quoted(trimmed(text)), count));
}

pugi::xml_node child_of(pugi::xml_node node, std::string_view name) {
  return node.find_child([&](pugi::xml_node child) { return is_named(child, name); });
}

std::string_view attribute_of(pugi::xml_node node, std::string_view name) {
  return node.find_attribute([&](pugi::xml_attribute a) { return name == a.name(); }).value();
}

}  // namespace bernal::cad
