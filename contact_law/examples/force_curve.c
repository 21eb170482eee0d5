/* Approach and separation of a sphere and a flat, as lines of numbers.

    cc -std=c99 -O2 -I.. force_curve.c -lm -o force_curve && ./force_curve > curve.txt */

#include <stdio.h>

#include "snapin_contact.h"

int main(void) {
  /* A sphere of 5 um on a flat, E* = 3.3 GPa, w = 50 mJ/m^2, z0 = 0.3 nm. */
  snapin_contact law;
  const double far = 4e-9, near = -3e-9;
  const int steps = 350;
  int i, in_contact = 0, failed;
  failed = snapin_contact_init(&law, 5e-6, 3.3e9, 0.05, 0.3e-9);
  if (failed) {
    fprintf(stderr, "snapin_contact_init: error %d\n", failed);
    return 1;
  }
  printf("# Tabor's parameter %.6g, pull-off force %.6g N\n", snapin_contact_tabor(&law),
         snapin_contact_pull_off(&law));
  printf("# snap-in at h0 = %.6g m, snap-off at %.6g m\n", snapin_contact_snap_in(&law),
         snapin_contact_snap_off(&law));
  printf("# h0 [m], in contact, load [N], contact radius [m], stiffness [N/m], energy [J]\n");
  for (i = 0; i <= 2 * steps; ++i) {
    const int step = i <= steps ? i : 2 * steps - i;
    const double h0 = far + (near - far) * step / steps;
    const double load = snapin_contact_load(&law, h0, &in_contact);
    printf("%.9g %d %.9g %.9g %.9g %.9g\n", h0, in_contact, load,
           snapin_contact_radius(&law, h0, &in_contact),
           snapin_contact_stiffness(&law, h0, &in_contact),
           snapin_contact_energy(&law, h0, &in_contact));
  }
  return 0;
}
