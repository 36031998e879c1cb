"""A page of headings, paragraphs, tables and pictures, as Markdown and as self-contained HTML."""

from __future__ import annotations

import base64
import html
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

CSS = """body{font:16px/1.5 system-ui,sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;font-size:14px;margin:1em 0}
td,th{border:1px solid #ccc;padding:.25em .6em;text-align:left}
th{background:#f2f2f2}tr.failed td{background:#fbdcdc}tr.known td{background:#fdecc8}img{max-width:100%}
.verdict{padding:.6em 1em;color:#fff;font-size:20px}
.verdict.passed{background:#2b7a3d}.verdict.failed{background:#b3261e}
figure{margin:1.5em 0}figcaption{color:#555}"""


@dataclass(frozen=True)
class Table:
    head: Sequence[str]
    rows: Sequence[tuple[str, Sequence[str]]]  # ("" | "failed" | "known", cells)

    def markdown(self) -> str:
        lines = [self.head, ["---"] * len(self.head), *(cells for _, cells in self.rows)]
        return (
            "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)
            + "\n"
        )

    def html(self) -> str:
        def line(tag: str, cells: Sequence[str], style: str = "") -> str:
            return (
                f'<tr class="{style}">' + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in cells) + "</tr>"
            )

        body = "".join(line("td", cells, style) for style, cells in self.rows)
        return f"<table>{line('th', self.head)}{body}</table>\n"


@dataclass(frozen=True)
class Picture:
    name: str
    path: Path
    caption: str


Block = str | Table | Picture  # a heading starts with "# ", anything else is a paragraph


def to_markdown(
    title: str, content: Sequence[Block], folder: Path, heading: str = "Verification report"
) -> str:
    parts = [f"# {heading}\n\n**{title}**\n"]
    for block in content:
        if isinstance(block, Table):
            parts.append(block.markdown())
        elif isinstance(block, Picture):
            parts.append(f"![{block.caption}]({block.path.relative_to(folder)})\n\n{block.caption}\n")
        else:
            parts.append(("#" if block.startswith("# ") else "") + block + "\n")
    return "\n".join(parts)


def to_html(title: str, passed: bool, content: Sequence[Block], heading: str = "Verification report") -> str:
    parts = []
    for block in content:
        if isinstance(block, Table):
            parts.append(block.html())
        elif isinstance(block, Picture):
            image = base64.b64encode(block.path.read_bytes()).decode()
            caption = html.escape(block.caption)
            source = f'<img alt="{caption}" src="data:image/png;base64,{image}">'
            parts.append(f"<figure>{source}<figcaption>{caption}</figcaption></figure>\n")
        elif block.startswith("# "):
            parts.append(f"<h2>{html.escape(block[2:])}</h2>\n")
        else:
            parts.append(f"<p>{html.escape(block)}</p>\n")
    head = f"<!doctype html><html lang='en'><meta charset='utf-8'><title>{heading}</title>"
    banner = f"<p class='verdict {'passed' if passed else 'failed'}'>{html.escape(title)}</p>"
    return f"{head}<style>{CSS}</style><h1>{heading}</h1>{banner}{''.join(parts)}</html>\n"
