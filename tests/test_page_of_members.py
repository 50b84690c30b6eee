"""Pages of the members of a study: made beside their results, linked both ways, or left out."""

import json

import pytest
from browser import window
from studies import LEAVES, Now, study

from mpmkit.study import collect, execute, members_of
from mpmkit.study.store import PAGE, Store

pytestmark = pytest.mark.usefixtures("undrawn")
ENDS = {"short": {"until": 0.002}, "stopped": {"until": 0.02, **LEAVES}}


def run(directory, given):
    """Run a study in this process, and return its members and its store."""
    members, store = members_of(given), Store(directory)
    with store.claimed(given, members):
        execute(members, store, executor=Now(), page="index.html" if given.pages else None)
        store.write(collect(given, members, store))
    return members, store


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A member that finishes, and one that a guard stops."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mpmkit.study.figures.draw", lambda *_: None)
        yield run(tmp_path_factory.mktemp("study") / "out", study(members=ENDS))


def test_each_member_has_a_page_also_one_that_a_guard_stopped(made):
    members, store = made
    pages = [store.page(member).read_text(encoding="utf-8") for member in members]
    assert "<title>short</title>" in pages[0]
    assert "The run came to its end" in pages[0]
    assert "A guard stopped the run" in pages[1]
    assert all(len(page.encode()) < 1_000_000 for page in pages)


def test_a_member_keeps_no_other_files_and_its_record_is_as_before(made):
    members, store = made
    names = {path.name for path in store.directory(members[0]).iterdir()}
    assert names == {"case.json", "history.nc", "member.json", PAGE}
    assert "page" not in json.loads((store.directory(members[0]) / "member.json").read_text())


def test_a_study_without_pages_links_to_directories_and_removes_older_pages(tmp_path):
    _, store = run(tmp_path / "out", study(members={"short": ENDS["short"]}))
    given = study(members={"short": {"until": 0.003}}, pages=False)
    store = Store(tmp_path / "out", overwrite=True)
    members = members_of(given)
    with store.claimed(given, members):
        execute(members, store, executor=Now())
        store.write(collect(given, members, store))
    assert store.page(members[0]) is None
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert f'href="members/{members[0].slug}/"' in page


def test_a_page_that_cannot_be_made_does_not_lose_the_run(tmp_path, monkeypatch, caplog):
    def fails(*_, **__):
        raise RuntimeError("no ink")

    monkeypatch.setattr("mpmkit.report.page.page_of", fails)
    members, store = run(tmp_path / "out", study(members={"short": ENDS["short"]}))
    assert store.outcome(members[0])["fate"] == "finished"
    assert store.page(members[0]) is None
    assert "the page of 'short' was not made: RuntimeError: no ink" in caplog.text


def test_a_browser_goes_from_the_study_to_a_member_and_back(made):
    _, store = made
    with window() as browser:
        browser.look(390)
        browser.open(store.path / "index.html")
        browser.find("#members td a, #members th a").click()
        browser.until("document.title === 'short' && document.documentElement.dataset.ready === 'yes'")
        assert browser.run("return mpmkit.page.player.flow.moments.length") > 1
        assert browser.run("return document.documentElement.scrollWidth") <= 390
        browser.find("nav a").click()
        browser.until("document.title === 'tiny' && document.documentElement.dataset.ready === 'yes'")
        assert browser.errors() == []
        assert browser.requests() == []
