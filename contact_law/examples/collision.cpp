// A collision of two equal spheres: approach, snap-in, impact, snap-off. The energy that they lose
// is that of the two jumps.
//
//     c++ -std=c++11 -O2 -I.. collision.cpp -o collision && ./collision

#include <cmath>
#include <cstdio>

#include "snapin_contact.h"

int main() {
  const double pi = 3.141592653589793, sphere = 1e-5, density = 1100, z0 = 0.3e-9;
  snapin_contact law;
  // R of two equal spheres is half of theirs.
  if (snapin_contact_init(&law, sphere / 2, 1e9, 0.05, z0)) return 1;
  const double lost = snapin_contact_energy_lost(&law);
  const double mass = 4 * pi / 3 * density * sphere * sphere * sphere / 2;  // reduced
  const double before = 5 * lost;
  double speed = -std::sqrt(2 * before / mass);

  // Two limits of the time step: a small part of the period of the stiffest contact, which a first
  // guess by Hertz theory gives; and a small part of z0, since the stiffness at a jump is infinite.
  const double deepest =
      std::pow(before / (8.0 / 15 * 1e9 * std::sqrt(sphere / 2)), 0.4) + 2 * law.gap_unit;
  int touching = 1;
  const double stiffest = snapin_contact_stiffness(&law, -deepest, &touching);
  const double step = std::fmin(0.02 * std::sqrt(mass / stiffest), 2e-4 * z0 / -speed);

  double h0 = 60 * z0;
  int in_contact = 0;
  long steps = 0;
  double force = snapin_contact_load(&law, h0, &in_contact);
  const double start = before + snapin_contact_energy(&law, h0, &in_contact);
  while (h0 <= 60 * z0 && steps < 100000000) {
    speed += step / 2 * force / mass;
    h0 += step * speed;
    force = snapin_contact_load(&law, h0, &in_contact);
    speed += step / 2 * force / mass;
    ++steps;
  }
  const double after = mass * speed * speed / 2 + snapin_contact_energy(&law, h0, &in_contact);
  std::printf("steps %ld\nenergy before %.9g J\nlost by integration %.9g J\nlost in jumps %.9g J\n",
              steps, start, start - after, lost);
  std::printf("coefficient of restitution %.6f\n", std::sqrt(mass * speed * speed / 2 / before));
  return 0;
}
