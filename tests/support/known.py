"""Numbers that other programs found; tests hold the program, its tools and the reference against
them."""

# By sigma: the largest tension over JKR's pull-off and its h0, then h0 and load (in gamma R) of the
# jumps in and out. Two independent solutions agree to one unit of the last digit.
BY_SIGMA = {
    0.87: (1.07953786, 2.2284576, 3.0886872, -1.5330549, 3.4834324, -2.9986585),
    8.7: (1.01124487, 6.2758749, 5.9728350, -0.4076839, 11.9352327, -2.6534864)}
# By Tabor's parameter: pull-off over pi w R and its h0, h0 and load over pi w R of the jumps in and
# out, energy lost over w R z0; and the error of each. Some last digits are cut off, not rounded.
BY_TABOR = {
    0.01: (1.998969, 1.0019),
    0.1: (1.968956, 1.0586),
    0.5: (1.787483, 1.4470),
    0.8: (1.706360, 1.7087, 2.37954, -0.85003, 2.40423, -1.08670, 0.0336),
    1.0: (1.670665, 1.8734, 2.62922, -0.68109, 2.74343, -1.03243, 0.2507),
    2.0: (1.583595, 2.6581, 3.55191, -0.36778, 4.38170, -0.90971, 2.8983),
    5.0: (1.525718, 4.9594, 5.26358, -0.16712, 9.18977, -0.85177, 16.2459),
}
ERRORS = (1.01e-6, 1.01e-4, 1.01e-5, 1.01e-5, 1.01e-5, 1.01e-5, 1.01e-4)
# A sphere on an incompressible film on something rigid: sqrt(R delta)/t, and the load over Hertz's.
SPHERE_ON_FILM = (
    (0.18507, 1.26977), (0.41721, 1.85712), (0.62011, 2.68406), (0.74794, 3.37110),
    (1.05444, 5.56319), (1.34893, 8.46801))
# A flat punch on such a film: a/t, and by Poisson's ratio F/(2 E* a delta) (Hayes et al. 1972 print
# 1.281, 1.683, 2.211, 2.855, 3.609 for 0.5).
PUNCH = (0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0)
PUNCH_ON_FILM = {0.5: (1.2806, 1.6837, 2.2129, 2.8602, 3.6187, 6.003, 9.150),
                 0.3: (1.2066, 1.4726, 1.7848, 2.1260, 2.4835, 3.4090, 4.3532)}
