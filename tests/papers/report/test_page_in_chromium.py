"""The page in a browser: no error, no request, every picture there, and views that answer to every control."""

import numpy as np
import pytest

from helpers.chromium import Browser
from semispline.papers.report.html_page import page

pytestmark = pytest.mark.browser

# The colours of a canvas as a list: the 2D canvas can be read at any time.
PIXELS = """(() => {
  const c = document.querySelector('#view-%s canvas');
  return Array.from(c.getContext('2d').getImageData(0, 0, c.width, c.height).data).filter((_, i) => i %% 4 < 3);
})()"""
# Drivers may round a pixel of an edge either way.
SAME = 1e-4
GREEN, RED = (63, 155, 79), (209, 64, 47)


@pytest.fixture(scope="module")
def browser(small_report, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "index.html"
    path.write_text(page(small_report[0]))
    with Browser() as opened:
        opened.open(path)
        yield opened
        # Whatever the tests above did: no error on the console, and nothing fetched but the page and what is inside.
        assert opened.problems == []
        assert opened.requests[0] == path.as_uri()
        assert all(url.startswith(("data:image/webp;", path.as_uri())) for url in opened.requests)


@pytest.fixture
def view(browser):
    """The view of Fig. 6 as it is when the page opens, in the middle of the window."""
    browser.run("document.querySelector('#view-figure-6 [data-reset]').click()")
    click(browser, "[data-mode=shaded]")
    browser.run("document.querySelector('#view-figure-6').scrollIntoView()")
    browser.settle()
    return pixels(browser)


def click(browser, selector, name="figure-6"):
    browser.run(f"document.querySelector('#view-{name} {selector}').click()")
    browser.settle()


def pixels(browser, name="figure-6"):
    return np.array(browser.run(PIXELS % name)).reshape(-1, 3)


def centre(browser):
    box = browser.run("(b => [b.x + b.width / 2, b.y + b.height / 2])"
                      "(document.querySelector('#view-figure-6 canvas').getBoundingClientRect())")  # fmt: skip
    return np.array(box)


def changed(before, after):
    """Return the fraction of pixels that differ visibly."""
    return (np.abs(before.astype(int) - after).max(axis=1) > 30).mean()


def hue_share(found, color):
    """Return the fraction of pixels whose colour is a lighter or darker shade of a given one."""
    unit = np.array(color) / np.linalg.norm(color)
    length = np.linalg.norm(found, axis=1)
    return ((found @ unit > 0.98 * length) & (length > 60)).mean()


def test_every_picture_loads(browser):
    sizes = browser.run("Array.from(document.images, i => [i.complete, i.naturalWidth, i.naturalHeight])")
    assert sizes == [[True, 1600, 533], [True, 300, 400]]


def test_formulas_are_laid_out(browser):
    browser.run("document.querySelectorAll('details').forEach(d => { d.open = true; })")
    sizes = browser.run("Array.from(document.querySelectorAll('math'), m => m.getBoundingClientRect().height)")
    assert len(sizes) >= 4
    # A fraction is taller than a line of text.
    assert max(sizes) > 25


def test_bases_are_green_and_the_blend_is_red(view):
    assert hue_share(view, GREEN) > 0.1
    assert hue_share(view, RED) > 0.05
    assert (view.min(axis=1) > 250).mean() > 0.2


def test_curvature_and_zebra_look_different(browser, view):
    click(browser, "[data-mode=curvature]")
    curvature = pixels(browser)
    click(browser, "[data-mode=zebra]")
    zebra = pixels(browser)
    assert changed(view, curvature) > 0.2
    assert changed(view, zebra) > 0.1
    assert changed(curvature, zebra) > 0.2
    # The paper's plane is grey, and neither green nor red is left; the shell bulges on one side.
    assert hue_share(curvature, GREEN) < 0.01
    assert (np.ptp(curvature, axis=1) < 12).mean() > hue_share(view, GREEN) / 4
    # Stripes: nearly white ones and coloured ones.
    assert hue_share(zebra, GREEN) > 0.05
    assert hue_share(zebra, RED) > 0.02


def test_the_scale_is_shown_with_curvature_only(browser, view):
    shown = "!document.querySelector('#view-figure-6 .scale').hidden"
    assert browser.run(shown) is False
    click(browser, "[data-mode=curvature]")
    assert browser.run(shown) is True


def test_dragging_turns_and_reset_turns_back(browser, view):
    middle = centre(browser)
    browser.drag(middle, middle + np.array((120, 40)))
    assert changed(view, pixels(browser)) > 0.05
    click(browser, "[data-reset]")
    assert changed(view, pixels(browser)) < SAME


def test_the_wheel_zooms_once_the_view_has_the_focus(browser, view):
    middle = centre(browser)
    browser.drag(middle, middle)
    browser.wheel(middle, -300)
    nearer = pixels(browser)
    assert (nearer.min(axis=1) > 250).mean() < (view.min(axis=1) > 250).mean() - 0.05
    browser.run("document.activeElement.blur()")
    browser.wheel(middle, -300)
    assert changed(nearer, pixels(browser)) < SAME


def test_keys_turn(browser, view):
    browser.run("document.querySelector('#view-figure-6 canvas').focus({ preventScroll: true })")
    press = "document.activeElement.dispatchEvent(new KeyboardEvent('keydown', { key: '%s', bubbles: true }))"
    browser.run(press % "ArrowLeft")
    browser.settle()
    assert changed(view, pixels(browser)) > 0.02
    browser.run(press % "ArrowRight")
    browser.settle()
    assert changed(view, pixels(browser)) < SAME


def test_another_method_and_its_control_points_are_drawn(browser, view):
    choose = (
        "(s => { s.value = '%d'; s.dispatchEvent(new Event('change')); })"
        "(document.querySelector('#view-figure-6 select'))"
    )
    click(browser, "[data-mode=zebra]")
    ours = pixels(browser)
    before = browser.run("document.querySelector('#view-figure-6 .numbers').textContent")
    browser.run(choose % 1)
    browser.settle()
    after = browser.run("document.querySelector('#view-figure-6 .numbers').textContent")
    assert "contact G2" in before
    assert "contact G1" in after
    printed = pixels(browser)
    assert changed(ours, printed) > 0.02
    click(browser, "input[type=checkbox]")
    # Lines and points of a few pixels.
    assert 0.001 < changed(printed, pixels(browser)) < 0.1
    click(browser, "input[type=checkbox]")
    browser.run(choose % 0)


def test_a_closed_blend_is_drawn_too(browser):
    browser.run("document.querySelector('#view-figure-10').scrollIntoView()")
    browser.settle()
    found = pixels(browser, "figure-10")
    assert hue_share(found, GREEN) > 0.1
    assert hue_share(found, RED) > 0.05


def test_filters_and_links_of_the_ledger(browser):
    shown = "Array.from(document.querySelectorAll('details.claim'), d => !d.hidden)"
    browser.run("document.querySelector('[data-verdict=holds]').click()")
    assert browser.run(shown) == [True, False]
    # A link to a hidden, closed record opens it.
    browser.run("document.getElementById('claim-eq-2').open = false; document.querySelector('.failures a').click()")
    browser.settle()
    assert browser.run(shown) == [True, True]
    assert browser.run("document.getElementById('claim-eq-2').open") is True
    browser.run("document.querySelector('[data-verdict=all]').click()")
    assert browser.run(shown) == [True, True]
