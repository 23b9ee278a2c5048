// The contacts of a cell, by value.
#pragma once

#include "core/contact/segment_contacts.hpp"

namespace rouleau::test {

inline core::ContactList contact_list(const core::SegmentContacts& contacts, const core::Membranes& membranes,
                                      int cell) {
  core::ContactList list;
  contacts.find(cell, membranes, list);
  return list;
}

}  // namespace rouleau::test
