// A membrane that keeps its length, by a penalty: energy w = E/12 (e - 1)^2 (e^2 + 2 e + 3)/e per rest length at the
// stretch e, tension T = dw/de = E/4 (e^2 - e^-2). Near e = 1 it is Hooke's law with the modulus E; unlike that it
// never lets a segment shrink to nothing, which a stiff and compressed membrane would otherwise do.
#include <rouleau/membrane.hpp>

struct Inextensible {
  double E;
  explicit Inextensible(const rouleau::Parameters& p) : E{p["stretching_modulus"]} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S e = segment.stretch, inverse = 1.0 / e, squared = inverse * inverse, strain = e - 1.0;
    return {E / 12 * strain * strain * ((e + 2.0) + 3.0 * inverse), 0.25 * E * (e * e - squared),
            0.5 * E * (e + inverse * squared)};
  }
};
ROULEAU_MEMBRANE(Inextensible, "inextensible", "1.0.0")
