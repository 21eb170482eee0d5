"""Claims about the header of the contact law: it compiles everywhere, it is the law in Python, and
no argument makes it fail."""

import shutil
import subprocess

import numpy as np
import pytest
from snapin.contact_law import ContactLaw
from support.contact_header import (
    COMPILER, FOLDER, HEADER, MUS, WARNINGS, Header, assert_same, bodies_at, compiled, gaps_of)

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")


@pytest.fixture(scope="module")
def header(tmp_path_factory):
    return Header(tmp_path_factory.mktemp("header"))


@pytest.mark.parametrize("mu", MUS)
def test_header_and_python_are_the_same_law(header, mu):
    law = ContactLaw(*bodies_at(mu))
    h0 = gaps_of(law, np.random.default_rng(1))
    before = np.arange(h0.size) % 2 == 1
    failed, found, after, numbers = header(bodies_at(mu), h0, before)
    assert failed == 0
    assert_same(law, h0, before, found.values(), after, numbers.values())


@pytest.mark.parametrize("mu", [0.3, 0.9, 5])
def test_contact_is_remembered_between_the_jumps(mu):
    law = ContactLaw(*bodies_at(mu))
    h0 = law.z0*np.linspace(12, -6, 901)
    h0 = np.concatenate([h0, h0[::-1]])
    state = law.history(h0)
    if not law.jumps:
        assert not state.any()
        return
    assert (state[:901] == (h0[:901] < law.snap_in)).all()
    assert (state[901:] == (h0[901:] <= law.snap_off)).all()


def test_header_is_small_and_names_its_errors():
    assert HEADER.stat().st_size <= 100_000
    head = HEADER.read_text().split("*/")[0]
    assert "Largest errors within the range of tables: 10000 random" in head


@pytest.mark.parametrize("language", ["c99", "c++11"])
def test_no_compiler_warns(tmp_path, language):
    text = ('#include "snapin_contact.h"\n'
            "int main(void) { snapin_contact law; int c = 0;\n"
            "return snapin_contact_init(&law, 1e-6, 1e9, 0.05, 3e-10) +\n"
            "  (snapin_contact_load(&law, 0, &c) > 1); }\n")
    compiler = COMPILER if language == "c99" else shutil.which("c++")
    if compiler is None:
        pytest.skip("no C++ compiler")
    for name in ("one", "two"):
        # Two files of one program.
        (tmp_path / f"{name}.{'c' if language == 'c99' else 'cpp'}").write_text(
            text.replace("main(void)", "other(void)") if name == "two" else text)
    subprocess.run([compiler, f"-std={language}", "-O2", *WARNINGS, f"-I{FOLDER}",
                    *map(str, tmp_path.iterdir()), "-o", str(tmp_path / "made"), "-lm"], check=True)


CAMPAIGN = r"""
#define _GNU_SOURCE
#include <fenv.h>
#include <stdio.h>
#include <stdlib.h>
#include "snapin_contact.h"
static const double given[] = {0, -0.0, -1, 1, 1e-9, 1e-3, 1e10, 1e-300, 1e300, -1e300, 5e-324,
  2e-308, 1.7e308, NAN, INFINITY, -INFINITY};
enum { COUNT = sizeof given / sizeof *given };
static double power_of_ten(double low, double high) {
  return pow(10, low + (high - low) * rand() / RAND_MAX);
}
int main(void) {
  static snapin_contact law;
  int a, b, c, d, h, state, k, wrong = 0, made = 0;
  double found[4];
  int stop = TRAPS;
  if (stop) feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  for (a = 0; a < COUNT; ++a) for (b = 0; b < COUNT; ++b)
  for (c = 0; c < COUNT; ++c) for (d = 0; d < COUNT; ++d) {
    int failed = snapin_contact_init(&law, given[a], given[b], given[c], given[d]);
    int bad = !isfinite(given[a]) || !isfinite(given[b]) || !isfinite(given[c]) ||
      !isfinite(given[d]) || given[a] <= 0 || given[b] <= 0 || given[c] <= 0 || given[d] <= 0;
    if (bad && failed != 1) ++wrong;
    made += !failed;
    if (failed && a % 4) continue;
    for (h = 0; h < COUNT; ++h) for (state = 0; state < 3; ++state) {
      int contact = state, *history = state < 2 ? &contact : 0;
      found[0] = snapin_contact_load(&law, given[h], history);
      found[1] = snapin_contact_radius(&law, given[h], history);
      found[2] = snapin_contact_stiffness(&law, given[h], history);
      found[3] = snapin_contact_energy(&law, given[h], history);
      for (k = 0; k < 4; ++k) if ((failed || !isfinite(given[h])) && !isnan(found[k])) ++wrong;
    }
    if (failed && !(isnan(snapin_contact_pull_off(&law)) && isnan(snapin_contact_snap_in(&law)) &&
      isnan(snapin_contact_energy_lost(&law)) && isnan(snapin_contact_tabor(&law)))) ++wrong;
  }
  if (snapin_contact_init(0, 1, 1, 1, 1) != 1 || !isnan(snapin_contact_load(0, 0, 0))) ++wrong;
  srand(5);
  for (a = 0; a < 4000; ++a) {
    double mu = power_of_ten(-8, 6), radius = power_of_ten(-9, 0), work = power_of_ten(-4, 0);
    double z0 = power_of_ten(-10, -7), scale = mu * z0;
    if (snapin_contact_init(&law, radius, sqrt(radius * work * work / (scale * scale * scale)),
                            work, z0)) ++wrong;
    for (b = 0; b < 40; ++b) {
      int contact = rand() % 2;
      double h0 = (rand() % 2 ? 1 : -1) * power_of_ten(-6, 8) * z0;
      if (!isfinite(snapin_contact_load(&law, h0, &contact))) ++wrong;
      if (!isfinite(snapin_contact_radius(&law, h0, &contact))) ++wrong;
      if (!isfinite(snapin_contact_energy(&law, h0, &contact))) ++wrong;
      if (isnan(snapin_contact_stiffness(&law, h0, &contact))) ++wrong;
    }
  }
  printf("%d wrong, %d made\n", wrong, made);
  return wrong != 0;
}
"""


@pytest.mark.slow
@pytest.mark.parametrize("traps", [0, 1])
def test_no_number_makes_it_fail(tmp_path, traps):
    """Zeros, negative, tiny, huge and no numbers give an error code or NaN, under the sanitizers,
    and in another run with traps of the processor."""
    options = [f"-DTRAPS={traps}"]
    if not traps:
        options += ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    try:
        program = compiled(tmp_path, CAMPAIGN, "campaign", *options)
    except subprocess.CalledProcessError:
        pytest.skip("no sanitizers, or no traps")
    done = subprocess.run([program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.startswith("0 wrong") and not done.stdout.endswith(" 0 made\n")


TIMING = r"""
#include <stdio.h>
#include <time.h>
#include "snapin_contact.h"
int main(void) {
  static snapin_contact law;
  double sum = 0, mu = MU, z0 = 3e-10, radius = 1e-6, work = 0.05, scale = mu * z0;
  double modulus = sqrt(radius * work * work / (scale * scale * scale)), h0;
  int i, contact = 0, calls = 400000, starts = 4000;
  clock_t start = clock();
  for (i = 0; i < starts; ++i)
    sum += snapin_contact_init(&law, radius, modulus * (1 + 1e-9 * i), work, z0);
  printf("init %.0f ns\n", (double)(clock() - start) / CLOCKS_PER_SEC / starts * 1e9);
  start = clock();
  for (i = 0; i < calls; ++i) {
    h0 = z0 * (5 + 3 * mu - (10 + 8 * mu) * ((i * 7919LL) % calls) / calls);
    sum += snapin_contact_load(&law, h0, &contact);
  }
  printf("call %.0f ns %g\n", (double)(clock() - start) / CLOCKS_PER_SEC / calls * 1e9, sum);
  return 0;
}
"""


@pytest.mark.alone
@pytest.mark.parametrize("mu", [0.1, 0.7, 3])
def test_a_call_takes_less_than_a_microsecond(tmp_path, mu):
    """Processor time at random h0: about 100 ns, 20 us for a start, five and ten times of which
    would be another algorithm."""
    program = compiled(tmp_path, TIMING, "timing", f"-DMU={mu}")
    lines = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    assert float(lines[lines.index("call") + 1]) < 500
    assert float(lines[lines.index("init") + 1]) < 200_000
