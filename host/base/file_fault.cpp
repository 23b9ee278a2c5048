#include "file_fault.hpp"

#include <cerrno>
#include <system_error>

#include "error.hpp"

namespace rouleau {

namespace {

Remedy remedy(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return {"free some space there, or write to another disk", {Way::elsewhere}};
    case EFBIG:
      return {"raise the file size limit (ulimit -f), or write fewer outputs"};
    case EACCES:
    case EPERM:
    case EROFS:
      return {"choose a directory you may write to", {Way::elsewhere}};
    case ENOENT:
    case ENOTDIR:
      return {"check that every part of the path before the last is a directory"};
    case ELOOP:
      return {"it is a link, and what it leads to is not this run's to change: remove the link"};
    case ENXIO:
      return {"it is a pipe that nobody reads: remove it"};
    case EMFILE:
    case ENFILE:
      return {"close other files, or raise the limit (ulimit -n)"};
    default:
      return {"check the disk, or write to another one", {Way::elsewhere}};
  }
}

}  // namespace

void fail_file(const std::filesystem::path& file, const std::string& what, int error) {
  throw Error(Cause::input_output, Place{file.string()}, what + ": " + std::generic_category().message(error),
              remedy(error));
}

void fail_reading(const std::filesystem::path& file, int error) {
  throw Error(Cause::input_output, Place{file.string()},
              "this file cannot be read: " + std::generic_category().message(error),
              {error == ENOENT   ? "bring the file back, or check the path"
               : error == EACCES ? "see to it that you may read it (ls -l)"
                                 : ""});
}

}  // namespace rouleau
