#include "checkpoint_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "file.hpp"
#include "hdf5/hdf5_rows.hpp"

namespace rouleau::files {

namespace {

constexpr std::size_t head_bytes = 512;  // the smallest that HDF5 allows
constexpr std::string_view checkpoint_format = "rouleau checkpoint 2";

std::string head(std::uintmax_t bytes, const std::string& checksum) {
  std::string text = std::string(checkpoint_format) + "\nbytes " + std::to_string(bytes) + "\nxxh3 " + checksum +
                     "\nHDF5 from byte 512 on\n";
  text.resize(head_bytes, '\n');
  return text;
}

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& how) {
  throw Error(Cause::input_output, Place{file.string()}, "is damaged: " + how);
}

std::uintmax_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) fail_reading(file, error.value());
  return size;
}

/// Throws unless the file is what its head says.
void verify(const std::filesystem::path& file) {
  std::array<char, head_bytes> begin{};
  if (InputFile(file).read(begin.data(), begin.size(), 0) != begin.size()) damaged(file, "it ends within its head");
  std::istringstream lines(std::string(begin.data(), begin.size()));
  std::string first, word, name, checksum;
  std::uintmax_t bytes = 0;
  std::getline(lines, first);
  if (first != checkpoint_format) {
    if (first.starts_with("rouleau checkpoint "))
      throw Error(Cause::bad_input, Place{file.string()},
                  "was written by another version of the program (\"" + first + "\"; this one reads \"" +
                      std::string(checkpoint_format) + "\")",
                  {"go on with that version, or begin anew", {Way::anew}});
    damaged(file, "it does not begin like a checkpoint");
  }
  lines >> word >> bytes >> name >> checksum;
  if (!lines || word != "bytes" || name != "xxh3") damaged(file, "its head cannot be read");
  const std::uintmax_t size = size_of(file);
  if (size - head_bytes != bytes)
    damaged(file, "it has " + std::to_string(size) + " bytes instead of " + std::to_string(bytes + head_bytes));
  if (checksum_text(checksum_of(file, head_bytes).value()) != checksum) damaged(file, "its checksum is wrong");
}

std::string parent_group(const std::string& path) { return path.substr(0, path.rfind('/')); }

}  // namespace

std::filesystem::path checkpoint_file(const std::filesystem::path& directory) { return directory / "checkpoint.h5"; }
std::filesystem::path previous_checkpoint_file(const std::filesystem::path& directory) {
  return directory / "checkpoint-previous.h5";
}

struct CheckpointWriter::File {
  explicit File(const std::filesystem::path& file) : hdf5(file, hdf5::File::Mode::create, head_bytes) {}
  void begin(const std::string& path, const std::vector<hsize_t>& shape, bool single) {
    const std::string group = parent_group(path);
    if (!group.empty() && !hdf5.has(group)) hdf5.make_group(group);
    open = hdf5.begin(path, shape, false, single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, "lattice units");
    width = shape.size() > 1 ? shape.back() : 1;
  }
  void write_bytes(const std::string& path, const void* data, std::size_t count) {
    hdf5.write(path, {count}, H5T_STD_U8LE, H5T_NATIVE_UINT8, data, "1");
  }
  hdf5::File hdf5;
  std::optional<hdf5::Rows> open;  ///< that append() adds to
  std::size_t width = 0;           ///< its columns
};

CheckpointWriter::CheckpointWriter(std::filesystem::path directory)
    : directory_(std::move(directory)),
      partial_(directory_ / (".checkpoint.h5." + std::to_string(::getpid()) + ".partial")),
      file_(std::make_unique<File>(partial_)) {}

CheckpointWriter::~CheckpointWriter() {
  file_.reset();
  std::error_code ignored;
  if (!partial_.empty()) std::filesystem::remove(partial_, ignored);
}

void CheckpointWriter::facts(const nlohmann::json& facts) {
  const std::string text = facts.dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
  file_->write_bytes("/facts", text.data(), text.size());
}

void CheckpointWriter::state(const nlohmann::json& state) {
  const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(state);
  file_->write_bytes("/state", bytes.data(), bytes.size());
}

void CheckpointWriter::begin_array(const std::string& path, std::size_t rows, std::size_t columns, bool single) {
  file_->begin(path, {rows, columns}, single);
}

void CheckpointWriter::begin_array(const std::string& path, std::size_t count) { file_->begin(path, {count}, false); }

void CheckpointWriter::append(const std::vector<double>& rows) {
  file_->open->append(rows.data(), rows.size() / file_->width);
}

void CheckpointWriter::finish() {
  file_->hdf5.close();
  file_.reset();
  bytes_ = size_of(partial_);
  const std::string text = head(bytes_ - head_bytes, checksum_text(checksum_of(partial_, head_bytes).value()));
  write_into(partial_, text);
}

void CheckpointWriter::take_place() {
  const auto present = checkpoint_file(directory_);
  if (std::filesystem::exists(present)) move_into_place(present, previous_checkpoint_file(directory_));
  move_into_place(partial_, present);
  partial_.clear();
}

struct CheckpointReader::File {
  explicit File(const std::filesystem::path& file) : hdf5(file, hdf5::File::Mode::read) {}
  void require(const std::filesystem::path& file, const std::string& path, std::size_t count) const {
    if (hdf5.elements(path) != count)
      damaged(file,
              path + " holds " + std::to_string(hdf5.elements(path)) + " values instead of " + std::to_string(count));
  }
  void read_block(const std::filesystem::path& file, const std::string& path, Pair size, Pair begin, Pair end,
                  double* values) const {
    const auto rows_first = [](Pair xy) {
      return std::vector<hsize_t>{static_cast<hsize_t>(xy[1]), static_cast<hsize_t>(xy[0])};
    };
    if (hdf5.shape(path) != std::vector<std::size_t>{rows_first(size)[0], rows_first(size)[1]})
      damaged(file, path + " has another shape than the lattice");
    hdf5.read(path, H5T_NATIVE_DOUBLE, rows_first(begin), rows_first(end), values);
  }
  hdf5::File hdf5;
};

CheckpointReader::CheckpointReader(const std::filesystem::path& file) : path_(file) {
  verify(file);
  file_ = std::make_unique<File>(file);
}

CheckpointReader::~CheckpointReader() = default;

void CheckpointReader::take_place(const std::filesystem::path& directory) const {
  if (path_ == previous_checkpoint_file(directory)) move_into_place(path_, checkpoint_file(directory));
}

nlohmann::json CheckpointReader::facts() const {
  std::string text(file_->hdf5.elements("/facts"), '\0');
  file_->hdf5.read("/facts", H5T_NATIVE_UINT8, text.data());
  auto facts = nlohmann::json::parse(text, nullptr, false);
  if (facts.is_discarded()) damaged(path_, "/facts is no JSON text");
  return facts;
}

nlohmann::json CheckpointReader::state() const {
  std::vector<std::uint8_t> bytes(file_->hdf5.elements("/state"));
  file_->hdf5.read("/state", H5T_NATIVE_UINT8, bytes.data());
  auto state = nlohmann::json::from_cbor(bytes, true, false);
  if (state.is_discarded()) damaged(path_, "/state is no CBOR");
  return state;
}

void CheckpointReader::refuse(const std::string& what) const {
  throw Error(Cause::input_output, Place{path_.string()},
              "does not hold what this program keeps in a checkpoint: " + what,
              {"go on with the program that wrote it, or begin anew", {Way::anew}});
}

bool CheckpointReader::has(const std::string& path) const { return file_->hdf5.has(path); }

std::vector<double> CheckpointReader::array(const std::string& path) const { return file_->hdf5.read(path); }

void CheckpointReader::array(const std::string& path, std::size_t count, double* values) const {
  file_->require(path_, path, count);
  file_->hdf5.read(path, H5T_NATIVE_DOUBLE, values);
}

void CheckpointReader::part(const std::string& path, std::size_t count, std::size_t begin, std::size_t end,
                            double* values) const {
  file_->require(path_, path, count);
  std::vector<hsize_t> first{begin}, last{end};
  if (file_->hdf5.shape(path).size() == 2) first.insert(first.begin(), 0), last.insert(last.begin(), 1);
  file_->hdf5.read(path, H5T_NATIVE_DOUBLE, first, last, values);
}

void CheckpointReader::block(const std::string& path, Pair size, Pair begin, Pair end, double* values) const {
  file_->read_block(path_, path, size, begin, end, values);
}

}  // namespace rouleau::files
