"""Pull-off force, snap-in and contact radius of silica spheres, from 10 nm to 1 mm."""

import numpy as np
import snapin

MODULUS, WORK, Z0 = 36e9, 0.05, 0.3e-9  # E* of silica on silica [Pa], [J/m^2], [m]

print("radius [m]  Tabor  pull-off [N]  over pi w R  snap-in h0 [m]  radius at no load [m]")
for radius in np.geomspace(1e-8, 1e-3, 6):
    law = snapin.contact_law.ContactLaw(radius, MODULUS, WORK, Z0)
    # Where the load is zero between the pull-off and a contact that is surely pressed.
    h0 = np.linspace(law.pull_off_h0, law.pull_off_h0 - 3*Z0*(1 + law.tabor), 2001)
    load = law.load(h0, True)
    contact = np.interp(0, load, law.contact_radius(h0, True))
    print(f"{radius:10.0e} {law.tabor:6.3f} {law.pull_off:13.5e}"
          f" {law.pull_off/(np.pi*WORK*radius):12.5f} {law.snap_in:15.4e} {contact:15.4e}")
