#include "hdf5_rows.hpp"

#include <algorithm>

namespace rouleau::hdf5 {

void File::write(const std::string& path, const std::vector<hsize_t>& shape, hid_t stored, hid_t given,
                 const void* data, const std::string& unit, int compression) {
  Rows rows = begin(path, shape, false, stored, given, unit, compression);
  if (!rows.full()) rows.append(data, shape.front());
}

Rows File::begin(const std::string& path, const std::vector<hsize_t>& shape, bool layers, hid_t stored, hid_t given,
                 const std::string& unit, int compression) {
  const auto space = owned(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose, path);
  const auto layout = untimed(H5P_DATASET_CREATE, path);
  const bool any = std::all_of(shape.begin(), shape.end(), [](hsize_t n) { return n > 0; });
  Rows rows(*this, path, shape, layers, given, unit);
  if (compression > 0 && any) {
    auto chunk = shape;
    hsize_t row = H5Tget_size(stored);
    for (std::size_t i = 1; i < shape.size(); ++i) row *= shape[i];
    chunk[0] = std::clamp<hsize_t>((hsize_t{1} << 20) / row, 1, shape[0]);
    check(H5Pset_chunk(layout.id(), static_cast<int>(chunk.size()), chunk.data()), path);
    check(H5Pset_shuffle(layout.id()), path);
    check(H5Pset_deflate(layout.id(), static_cast<unsigned>(compression)), path);
    rows.together_ = chunk[0] * (layers ? shape[1] : 1);
  }
  rows.dataset_ =
      owned(H5Dcreate2(handle_.id(), path.c_str(), stored, space.id(), H5P_DEFAULT, layout.id(), H5P_DEFAULT), H5Dclose,
            path);
  rows.bytes_of_row_ = H5Tget_size(given);
  for (std::size_t i = layers ? 2 : 1; i < shape.size(); ++i) rows.bytes_of_row_ *= shape[i];
  if (any) rows.all_ = layers ? shape[0] * shape[1] : shape[0];
  if (rows.full()) rows.finish();
  return rows;
}

void Rows::append(const void* data, std::size_t count) {
  if (count == 0) return;  // behind the last row, too
  const auto* rows = static_cast<const std::byte*>(data);
  const auto keep = [&](std::size_t n) {
    waiting_.insert(waiting_.end(), rows, rows + n * bytes_of_row_);
    rows += n * bytes_of_row_;
    count -= n;
  };
  if (!waiting_.empty()) {
    const std::size_t kept = waiting_.size() / bytes_of_row_;
    keep(std::min<std::size_t>(count, together_ - kept));
    const std::size_t now = waiting_.size() / bytes_of_row_;
    if (now < together_ && written_ + now < all_) return;
    put(waiting_.data(), now);
    waiting_.clear();
  }
  const std::size_t whole = written_ + count == all_ ? count : count / together_ * together_;
  if (whole > 0) put(rows, whole);
  rows += whole * bytes_of_row_;
  count -= whole;
  keep(count);
  if (full()) finish();
}

void Rows::put(const std::byte* rows, hsize_t count) {
  const auto space = file_->owned(H5Dget_space(dataset_.id()), H5Sclose, path_);
  while (count > 0) {
    std::vector<hsize_t> begin(shape_.size(), 0), size = shape_;
    hsize_t taken = count;
    begin[0] = written_, size[0] = count;
    if (layers_) {
      // Whole layers at once, and what there is of one.
      const hsize_t of_layer = shape_[1], in_layer = written_ % of_layer;
      const bool whole = in_layer == 0 && count >= of_layer;
      begin[0] = written_ / of_layer, size[0] = whole ? count / of_layer : 1;
      begin[1] = in_layer, size[1] = whole ? of_layer : std::min(count, of_layer - in_layer);
      taken = size[0] * size[1];
    }
    const auto memory =
        file_->owned(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose, path_);
    file_->check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin.data(), nullptr, size.data(), nullptr), path_);
    file_->check(H5Dwrite(dataset_.id(), given_, memory.id(), space.id(), H5P_DEFAULT, rows), path_);
    written_ += taken;
    count -= taken;
    rows += taken * bytes_of_row_;
  }
}

void Rows::finish() {
  waiting_ = {};
  if (!dataset_.close()) file_->fail(path_);
  file_->attribute(path_, "unit", unit_);
}

}  // namespace rouleau::hdf5
