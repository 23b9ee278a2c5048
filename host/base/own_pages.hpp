// The pages of a loaded library, kept apart from its file.
#pragma once

namespace rouleau {

/// Puts copies in the places of a loaded library's pages, so that it stays what it is when somebody writes to its file
/// or cuts it short. `handle`: as dlopen gave it. Where the system refuses, pages stay as they are.
void own_pages(void* handle);

}  // namespace rouleau
