#!/usr/bin/python3
"""The documentation site as a reader sees it: three pages opened from the folder in headless Chromium, wide and narrow.

usage: site_test.py SITE [options of unittest]

No script complains, nothing but files is loaded, equations are typeset, the search finds, the navigation is there.
With BENTAXIS_SCREENSHOTS=DIR the pages are also saved there as pictures. Without Chromium: exit status 77.
"""
import os
import pathlib
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "scripts"))
sys.dont_write_bytecode = True
from documentation.browser import Browser, find  # noqa: E402

WIDTHS = (1280, 420)
PAGES = ("index.html", "docs/theory.html", "docs/reference/commands/compare.html")
# What is typed, and a page that must be among the first results.
QUERIES = {"cavitation": "hydraulics", "sweep": "sweep", "tapered": "bearing"}
NO_CHROMIUM = 77
# Equations whose number begins before their last part ends.
OVERLAPS = """[...document.querySelectorAll('.katex-display .katex-html')].filter(line => {
  const tag = line.querySelector(':scope > .tag'), last = [...line.querySelectorAll(':scope > .base')].pop();
  return tag && last && tag.getBoundingClientRect().left < last.getBoundingClientRect().right;
}).map(line => line.innerText.slice(0, 60))"""

SITE = None  # set in main


class SiteTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser().__enter__()
        cls.addClassCleanup(cls.browser.__exit__, None, None, None)

    def open(self, page, width):
        self.browser.open(SITE / page, width)
        self.save(f"{page.replace('/', '_').removesuffix('.html')}_{width}")

    def save(self, name):
        folder = os.environ.get("BENTAXIS_SCREENSHOTS")
        if folder:
            self.browser.wait_for("document.fonts.status === 'loaded'")
            time.sleep(0.5)  # what moves in comes to rest
            self.browser.picture(pathlib.Path(folder) / f"site_{name}.png")

    def assert_clean(self):
        self.assertEqual(self.browser.complaints, [])
        foreign = [url for url in self.browser.requests if not url.startswith((SITE.as_uri() + "/", "data:", "blob:", "about:"))]
        self.assertEqual(foreign, [])

    def test_pages_load_without_complaint(self):
        for page in PAGES:
            for width in WIDTHS:
                with self.subTest(page=page, width=width):
                    self.open(page, width)
                    self.assertTrue(self.browser.wait_for("document.documentElement.classList.contains('js')"))
                    self.assertGreater(self.browser.evaluate("document.querySelector('article').innerText.length"), 200)
                    # Nothing is wider than the window; what is wide scrolls within the page.
                    self.assertLessEqual(self.browser.evaluate("document.scrollingElement.scrollWidth"), width)
                    self.assert_clean()

    def test_equations_are_typeset(self):
        pages = [page.relative_to(SITE).as_posix() for page in sorted(SITE.rglob("*.html")) if 'class="arithmatex"' in page.read_text(encoding="utf-8")]
        self.assertNotEqual(pages, [])
        for page in pages:
            with self.subTest(page=page):
                self.open(page, 1280)
                equations = self.browser.evaluate("document.querySelectorAll('.arithmatex').length")
                typeset = self.browser.wait_for(
                    f"(n => n >= {equations} && n)([...document.querySelectorAll('.arithmatex')].filter(e => e.querySelector('.katex-html')).length)")
                self.assertEqual(typeset, equations)
                self.assertEqual(self.browser.evaluate("document.querySelectorAll('.katex-error').length"), 0)
                # No number is written over its equation, wide or narrow.
                for width in WIDTHS:
                    self.browser.resize(width)
                    self.assertTrue(self.browser.wait_for("document.documentElement.dataset.equations === 'ready'"))
                    self.assertEqual(self.browser.evaluate(OVERLAPS), [])
                # In KaTeX's own fonts, which come with the site.
                self.assertTrue(self.browser.wait_for("document.fonts.check('16px KaTeX_Main')"))
                self.assert_clean()

    def test_the_search_finds(self):
        for width in WIDTHS:
            for query, expected in QUERIES.items():
                with self.subTest(width=width, query=query):
                    # On a busy machine keys can be typed before the page listens: then once more from the start.
                    for _ in range(3):
                        self.open("index.html", width)
                        if width < 960:  # the field is behind its button
                            self.browser.evaluate("document.querySelector('label[for=__search]').click()")
                        self.browser.evaluate("document.querySelector('.md-search__input').focus()")
                        self.browser.type(query)
                        found = self.browser.wait_for("(l => l.length && l)([...document.querySelectorAll('.md-search-result__link')].map(a => a.href))")
                        if found:
                            break
                    self.assertTrue(found, "no results")
                    self.assertTrue(any(expected in url for url in found[:5]), found[:5])
                    self.assertTrue(all(url.startswith(SITE.as_uri() + "/") for url in found), found)
                    self.assert_clean()

    def test_a_word_that_is_nowhere_is_not_found(self):
        self.open("index.html", 1280)
        self.browser.evaluate("document.querySelector('.md-search__input').focus()")
        self.browser.type("xyzzyq")
        self.assertTrue(self.browser.wait_for("/^No /.test(document.querySelector('.md-search-result__meta').innerText)"))
        self.assertEqual(self.browser.evaluate("document.querySelectorAll('.md-search-result__link').length"), 0)

    def test_the_navigation_is_there(self):
        # What a reader can click: the topmost element at its middle.
        shown = """[...document.querySelectorAll('nav a, nav label')].filter(e => {
              const box = e.getBoundingClientRect();
              const top = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
              return top && (e.contains(top) || top.contains(e) && top.closest('nav'));
            }).map(e => e.innerText.trim())"""
        sections = ["Start", "Tutorials", "How-to", "Reference", "Theory", "Verification", "For developers"]
        for width in WIDTHS:
            with self.subTest(width=width):
                self.open("index.html", width)
                if width < 1220:  # behind the button of three lines, one level up
                    self.assertNotIn("Reference", self.browser.evaluate(shown))
                    self.browser.evaluate("document.querySelector('label[for=__drawer]').click()")
                    self.browser.evaluate("[...document.querySelectorAll('.md-nav__title')].find(e => e.innerText.trim() === 'Start').click()")
                found = self.browser.wait_for(f"(l => {sections}.every(s => l.includes(s)) && l)({shown})") or self.browser.evaluate(shown)
                for section in sections:
                    self.assertIn(section, found)
                self.save(f"navigation_{width}")
                # One click further is a page.
                self.browser.evaluate("[...document.querySelectorAll('nav a, nav label')].filter(e => e.innerText.trim() === 'Theory').pop().click()")
                self.assertTrue(self.browser.wait_for("[...document.querySelectorAll('nav a')].some(e => e.href.endsWith('docs/theory.html'))"))
                self.assert_clean()


def main():
    global SITE
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    SITE = pathlib.Path(sys.argv.pop(1)).resolve()
    if not (SITE / "index.html").exists():
        sys.exit(f"site_test: no site in {SITE}: run scripts/build_site")
    if find() is None:
        print("site_test: Chromium is not installed")
        sys.exit(NO_CHROMIUM)
    unittest.main()


if __name__ == "__main__":
    main()
