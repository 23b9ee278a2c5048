#include "segment_table.hpp"

#include <rouleau/dispatch.hpp>

namespace rouleau::core {

namespace {

struct UpdateTask {
  const double *from_x, *from_y;
  double *x, *y, *along_x, *along_y, *inverse_square;
  int first, end;
  BoundingBox<2> box;
};

struct Update {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(UpdateTask* task) {
    using S = Pack<double, register_bytes / 8>;
    const UpdateTask t = *task;
    int i = t.first;
    S x_min = t.from_x[i], x_max = x_min, y_min = t.from_y[i], y_max = y_min;
    for (; i + S::size < t.end; i += S::size) {
      const S x = S::load(t.from_x + i), y = S::load(t.from_y + i);
      x_min = min(x_min, x), x_max = max(x_max, x), y_min = min(y_min, y), y_max = max(y_max, y);
      const S dx = S::load(t.from_x + i + 1) - x, dy = S::load(t.from_y + i + 1) - y, square = dx * dx + dy * dy;
      x.store(t.x + i);
      y.store(t.y + i);
      dx.store(t.along_x + i);
      dy.store(t.along_y + i);
      select(square > S(0.0), 1.0 / square, S(0.0)).store(t.inverse_square + i);
    }
    BoundingBox<2> b{{least(x_min), least(y_min)}, {largest(x_max), largest(y_max)}};
    for (; i < t.end; ++i) {
      const double x = t.from_x[i], y = t.from_y[i];
      b = {{min(b.least[0], x), min(b.least[1], y)}, {max(b.most[0], x), max(b.most[1], y)}};
      const int next = i + 1 == t.end ? t.first : i + 1;
      const double dx = t.from_x[next] - x, dy = t.from_y[next] - y, square = dx * dx + dy * dy;
      t.x[i] = x;
      t.y[i] = y;
      t.along_x[i] = dx;
      t.along_y[i] = dy;
      t.inverse_square[i] = square > 0 ? 1 / square : 0.0;
    }
    task->box = b;
  }
};

}  // namespace

SegmentTable::SegmentTable(const Membranes& membranes) : boxes(membranes.cells.size()) {
  const std::size_t size = membranes.position[0].size() + margin;
  for (auto* values : {&x, &y, &along_x, &along_y, &inverse_square}) *values = PagedArray<double>(size);
}

void SegmentTable::update(Worker worker, const Membranes& membranes) {
  static const auto function = Dispatch<Update, UpdateTask*>::pick();
  const CellNumbers cells = membranes.known_cells(worker);
  for (const int c : cells) {
    const CellRange& cell = membranes.cells[c];
    UpdateTask task{membranes.position[0].data(),
                    membranes.position[1].data(),
                    x.data(),
                    y.data(),
                    along_x.data(),
                    along_y.data(),
                    inverse_square.data(),
                    cell.first,
                    cell.end(),
                    {}};
    function(&task);
    boxes[c] = task.box;
  }
}

}  // namespace rouleau::core
