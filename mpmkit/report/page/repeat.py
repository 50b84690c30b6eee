"""Section: how the run was made, and how to repeat it."""

from __future__ import annotations

import json
from html import escape

from .section import Section, folded, pairs, paragraph, table
from .source import START, Source

LONGEST = 100_000
"""Most characters of a case on the page."""


def section(source: Source) -> Section:
    """Command, versions, machine, plug-ins and the whole case."""
    attributes = source.results.history.attrs
    versions = json.loads(attributes.get("versions", "{}"))
    machine = json.loads(attributes.get("machine", "{}"))
    commands = [said.text.removeprefix(START) for said in source.log if said.text.startswith(START)]
    body = ""
    if commands:
        body += paragraph("The run was made with")
        body += f'<pre class="command" tabindex="0"><code>{escape(chr(10).join(commands))}</code></pre>'
    body += paragraph("To repeat it from its directory and compare the results bit by bit:")
    body += '<pre class="command" tabindex="0"><code>mpmkit rerun DIRECTORY</code></pre>'
    facts = [("Versions", ", ".join(f"{name} {version}" for name, version in versions.items()))]
    facts += [(str(name).capitalize(), str(value)) for name, value in machine.items()]
    body += pairs((term, text) for term, text in facts if text)
    plugins = json.loads(attributes.get("plugins", "[]"))
    if plugins:
        rows = [
            (
                p["kind"].replace("_", " "),
                p["name"],
                p.get("distribution", "not installed"),
                p.get("version", ""),
            )
            for p in plugins
        ]
        body += table(("kind", "plug-in", "package", "version"), rows, "Plug-ins of the run")
    body += folded("The whole case, with every default filled in", _case(source))
    return Section("repeat", "How the run was made", body)


def _case(source: Source) -> str:
    text = json.dumps(source.results.case, indent=2, ensure_ascii=False)
    if len(text) > LONGEST:
        return paragraph(f"The case has {len(text)} characters: see case.json in the directory of the run.")
    return f'<pre tabindex="0"><code>{escape(text)}</code></pre>'
