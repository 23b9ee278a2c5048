// The contacts of a cell, by value.
#pragma once

#include "core/contact/contact.hpp"

namespace rouleau::test {

inline core::ContactList contact_list(const core::Contacts& contacts, const core::Membranes& membranes, int cell) {
  core::ContactList list;
  contacts.find(cell, membranes, list);
  return list;
}

}  // namespace rouleau::test
