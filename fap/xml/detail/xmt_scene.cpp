#include "fap/xml/detail/xmt_scene.h"

#include "fap/xml/detail/numbers.h"

namespace animeme::head::detail {
namespace {

Position at(const XmlElement& element) { return {{}, element.line, 0, -1}; }

// Fields whose values are numbers; of the others the first word counts.
bool has_numbers(std::string_view field) {
  for (const std::string_view known :
       {"point", "color", "coordIndex", "colorIndex", "translation", "rotation", "scale",
        "scaleOrientation", "center", "diffuseColor"}) {
    if (field == known) return true;
  }
  return false;
}

}  // namespace

bool is_node(const XmlElement& element) {
  return !element.name.empty() && element.name[0] >= 'A' && element.name[0] <= 'Z';
}

const XmlElement* find_element(const XmlElement& root, std::string_view name) {
  if (root.name == name) return &root;
  for (const XmlElement& child : root.children) {
    if (const XmlElement* found = find_element(child, name)) return found;
  }
  return nullptr;
}

void XmtScene::collect(const XmlElement& element) {
  if (const std::string* name = element.attribute("DEF")) defs_.try_emplace(*name, &element);
  for (const XmlElement& child : element.children) collect(child);
}

const XmlElement* XmtScene::resolved(const XmlElement& element) const {
  const std::string* use = element.attribute("USE");
  if (use == nullptr) return &element;
  const auto found = defs_.find(*use);
  return found == defs_.end() ? nullptr : found->second;
}

Result<SceneNodePtr> XmtScene::node(const XmlElement& element) {
  const XmlElement* source = resolved(element);
  if (source == nullptr) {
    missing_.insert(*element.attribute("USE"));
    return SceneNodePtr();
  }
  if (const auto made = made_.find(source); made != made_.end()) return made->second;
  if (depth_ > kDeepestNode) {
    return element.error(Code::out_of_range, "nodes are nested too deep");
  }
  if (!open_.insert(source).second) {
    return element.error(Code::syntax, "the node <" + source->name + "> contains itself by USE");
  }
  auto node = std::make_shared<SceneNode>();
  node->type = source->name;
  node->where = at(*source);
  if (const std::string* name = source->attribute("DEF")) node->name = *name;
  ++depth_;
  const Result<void> done = fill(*node, *source);
  --depth_;
  open_.erase(source);
  if (!done) return done.error();
  made_[source] = node;
  return node;
}

Result<SceneNodePtr> XmtScene::node_in(const XmlElement& element, std::string_view field) {
  const XmlElement* wrapper = element.child(field);
  if (wrapper == nullptr) return SceneNodePtr();
  for (const XmlElement& child : wrapper->children) {
    if (is_node(child)) return node(child);
  }
  return SceneNodePtr();
}

Result<void> XmtScene::fill(SceneNode& node, const XmlElement& element) {
  for (const XmlElement::Attribute& attribute : element.attributes) {
    if (auto done = fill_attribute(node, element, attribute); !done) return done;
  }
  for (const XmlElement& child : element.children) {
    if (is_node(child)) {  // without a field around it, as some write
      if (auto done = add_child(node, "children", child); !done) return done;
      continue;
    }
    for (const XmlElement& inner : child.children) {
      if (!is_node(inner)) continue;
      if (auto done = add_child(node, child.name, inner); !done) return done;
    }
  }
  return {};
}

Result<void> XmtScene::fill_attribute(SceneNode& node, const XmlElement& element,
                                      const XmlElement::Attribute& attribute) {
  if (attribute.name == "DEF" || attribute.name == "USE") return {};
  SceneValue value;
  value.where = at(element);
  if (has_numbers(attribute.name)) {
    auto numbers = numbers_of(element, attribute.name);
    if (!numbers) return numbers.error();
    value.numbers = std::move(*numbers);
  } else {
    value.words = {attribute.value};
  }
  return set_field(node, attribute.name, std::move(value));
}

Result<void> XmtScene::add_child(SceneNode& node, std::string_view field, const XmlElement& child) {
  auto made = this->node(child);
  if (!made) return made.error();
  if (!*made) return {};
  SceneValue value;
  value.where = at(child);
  value.nodes.push_back(std::move(*made));
  return set_field(node, field, std::move(value));
}

}  // namespace animeme::head::detail
