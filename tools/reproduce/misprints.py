"""What the paper misprints, each with a computation that decides it."""

import curves
import numpy as np
from published import Row

DECKS = ("fig01_lennard_jones", "fig06_converged")
TITLE = "Misprints, and how they were settled"
CAPTION = """The text of the paper that was available here is a machine reading of the printed
pages; some of these may be the reader's. None of them touches the paper's figures.

- **Kernel (15).** It must be 4 K/(π r), as (13) requires: with it, Hertz's pressure displaces the
  axis by {right:.6f} a²/R, (4) being one. Without 1/π it would be {without:.4f}; with 4π K/r,
  as the text at hand reads, {printed:.4f}.
- **K(m) "of modulus m".** m = t²/r² is the parameter, k². At t = r/2 the angular integral of 1/|r
  − t| is {angular:.6f}/r; the parameter gives {parameter:.6f}, the modulus {modulus:.6f}.
- **(8)** is missing from the text. With the contact energy −c π a² γ, the displacement (11) is
  the one of least energy for c = {coefficient:.6f}: (8) is −π a² γ.
- **Fig. 1, µN/m.** 1.5 π γ R is {pull_off:.2f} µN there, the paper's 56: a force.
- **Fig. 6(d), γ = 0.80 mJ/m².** A = 1e-19 J and z0 = 0.5 nm make γ = {gamma:.2f} mJ/m² by (34),
  and the energy computed goes down to {energy:.2f}. 0.80 belongs to Fig. 1.
- **E in J m⁻³** is Pa. **Sec. III C** has σ "Eq. (39)" where it means (40), as the caption of
  Fig. 9 has it."""


def _elliptic(m):
    """Return K of parameter m by the arithmetic-geometric mean."""
    a, b = 1.0, np.sqrt(1 - m)
    while abs(a - b) > 1e-15:
        a, b = (a + b) / 2, np.sqrt(a * b)
    return np.pi / (2 * a)


def evidence(runs):
    """Return the numbers that decide, a dict."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    nodes, weights = (nodes + 1) / 2, weights / 2
    # Displacement 2 (1-nu^2)/E * Int p k t dt on the axis over a^2/R, for p of (3) and t = a sin x.
    x = np.pi / 2 * nodes
    pressure, kernel = np.cos(x) / np.pi, 4 / np.pi * _elliptic(0.0)
    axis = 2 * np.sum(np.pi / 2 * weights * pressure * kernel * np.cos(x))
    angle = 2 * np.pi * nodes
    angular = np.sum(2 * np.pi * weights / np.sqrt(1 + 0.25 - np.cos(angle)))
    # d/da of the elastic energy E*(delta^2 a - 2 delta a^3/(3 R) + a^5/(5 R^2)) at fixed delta must
    # be c*2*pi*a*gamma, with E* = stiffness/2.
    radius, stiffness, gamma = 1.5e-2, 1e10, 8e-4
    a = 5e-6
    delta, _ = curves.jkr(a, radius, stiffness, gamma)
    slope = stiffness / 2 * (delta - a**2 / radius) ** 2
    energy = runs["fig06_converged"].profiles["energy"].min()
    return {
        "right": axis, "without": np.pi * axis, "printed": np.pi**2 * axis,
        "angular": angular, "parameter": 4 * _elliptic(0.25), "modulus": 4 * _elliptic(0.25**2),
        "coefficient": slope / (2 * np.pi * a * gamma),
        "pull_off": runs["fig01_lennard_jones"].summary["jkr_pull_off"] * 1e6,
        "gamma": runs["fig06_converged"].summary["surface_energy"] * 1e3, "energy": energy * 1e3,
    }


numbers = evidence


def rows(runs):
    """Return one row a misprint."""
    found = evidence(runs)
    return [
        Row("Misprint, (15): factor of the kernel", "4 pi K/r", None,
            "4 K/(pi r)", "", "displacement of Hertz's pressure on the axis, over the a^2/R of "
            f"(4): {found['printed']:.4f} as read, {found['without']:.4f} without 1/pi, "
            f"{found['right']:.6f} with 4 K/(pi r)"),
        Row("Misprint, (15): what m is in K(m)", "modulus", None, "parameter", "",
            f"r times the angular integral of 1/abs(r-t) at t = r/2: {found['angular']:.6f}; 4 K "
            f"with m as modulus {found['modulus']:.6f}, as parameter {found['parameter']:.6f}"),
        Row("Misprint, (8): contact energy over pi a^2 gamma", "missing", None,
            -found["coefficient"], "", "with this, (11) is the displacement of least energy"),
        Row("Misprint, Fig. 1: units of load", "µN/m", None, found["pull_off"], "µN",
            "1.5 pi gamma R, the paper's 56: a force"),
        Row("Misprint, Fig. 6(d): gamma", 0.80, None, found["gamma"], "mJ/m^2",
            "by (34) for A = 1e-19 J; least energy computed: "
            f"{found['energy']:.4f} mJ/m^2"),
        Row("Misprint, units of E", "J m^-3", None, "Pa", "", "the same dimension"),
        Row("Misprint, Sec. III C: definition of sigma", "Eq. (39)", None, "Eq. (40)", "",
            "as the caption of Fig. 9 has it; (39) is Lambda"),
    ]
