// Faults on purpose, one for each argument: what the sanitizers of this build must find.
#include <climits>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace {

struct Shape {
  virtual ~Shape() = default;
  [[nodiscard]] virtual int corners() const { return 0; }
};
struct Triangle : Shape {
  [[nodiscard]] int corners() const override { return 3; }
};

int read_beyond(int count) {
  const std::vector<int> numbers(static_cast<std::size_t>(count));
  return numbers.data()[count];
}

int read_freed(int count) {
  const int* freed = nullptr;
  {
    const std::vector<int> numbers(static_cast<std::size_t>(count));
    freed = numbers.data();
  }
  return *freed;
}

int read_out_of_scope(int count) {
  const int* volatile gone = nullptr;
  {
    volatile int number = count;
    gone = const_cast<const int*>(&number);
  }
  return *gone;
}

int leak(int count) {
  // Volatile: otherwise the compiler, or a register with the old address, would hide the leak.
  int* volatile numbers = new int[static_cast<std::size_t>(count)]();
  const int first = numbers[0];
  numbers = nullptr;
  return first;
}

int overflow(int count) { return INT_MAX - 2 + count; }

int shift(int count) { return 1 << (count + 30); }

int read_outside_array(int count) {
  const int numbers[3] = {1, 2, 3};
  return numbers[count];
}

int wrong_type(int) {
  Shape shape;
  void* volatile place = &shape;
  return static_cast<Triangle*>(place)->corners();
}

}  // namespace

int main(int argument_count, char** arguments) {
  const std::map<std::string, int (*)(int)> faults{{"read_beyond", read_beyond},
                                                   {"read_freed", read_freed},
                                                   {"read_out_of_scope", read_out_of_scope},
                                                   {"leak", leak},
                                                   {"overflow", overflow},
                                                   {"shift", shift},
                                                   {"read_outside_array", read_outside_array},
                                                   {"wrong_type", wrong_type}};
  const auto fault = argument_count == 2 ? faults.find(arguments[1]) : faults.end();
  if (fault == faults.end()) return 2;
  volatile int three = 3;  // known only when the program runs
  std::printf("%s gave %d and was not found\n", arguments[1], fault->second(three));
  return 0;
}
