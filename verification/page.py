"""A page of headings, paragraphs, tables and pictures, as Markdown and as self-contained HTML."""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

CSS = """body{font:16px/1.5 system-ui,sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;font-size:14px;margin:1em 0;display:block;overflow-x:auto}
td,th{border:1px solid #ccc;padding:.25em .6em;text-align:left}
th{background:#f2f2f2}tr.failed td{background:#fbdcdc}tr.known td{background:#fdecc8}img{max-width:100%}
.verdict{padding:.6em 1em;color:#fff;font-size:20px}
.verdict.passed{background:#2b7a3d}.verdict.failed{background:#b3261e}
figure{margin:1.5em 0}figcaption{color:#555}
.gallery{display:grid;grid-template-columns:repeat(auto-fill,minmax(260px,1fr));gap:1em;margin:1em 0}
.card{border:1px solid #ccc;border-top:4px solid #2b7a3d;padding:.6em;font-size:14px}
.card{color:inherit;text-decoration:none}.card:hover{background:#f7f7f7}
.card.known,.card.reported{border-top-color:#e0a100}.card.failed{border-top-color:#b3261e}
.card img{display:block;width:100%;height:160px;object-fit:contain;margin-bottom:.5em}
.card b{display:block}"""


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
    case: str = ""


@dataclass(frozen=True)
class Card:
    """A small picture that leads to the heading with the card's title."""

    title: str
    sentence: str
    verdict: str  # "passed", "known", "reported" or "failed"
    image: bytes  # PNG


Block = str | Table | Picture | list[Card]  # a heading starts with "# " or "## ", another text is a paragraph


def _slug(heading: str) -> str:
    """The name by which a heading is linked to, as Markdown pages make it."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def to_markdown(
    title: str, content: Sequence[Block], folder: Path, heading: str = "Verification report"
) -> str:
    parts = [f"# {heading}\n\n**{title}**\n"]
    for block in content:
        if isinstance(block, Table):
            parts.append(block.markdown())
        elif isinstance(block, Picture):
            parts.append(f"![{block.caption}]({block.path.relative_to(folder)})\n\n{block.caption}\n")
        elif isinstance(block, list):
            lines = (f"- [{card.title}](#{_slug(card.title)}): {card.sentence}\n" for card in block)
            parts.append("".join(lines))
        else:
            parts.append(("#" if block.startswith("#") else "") + block + "\n")
    return "\n".join(parts)


def _image(data: bytes, alternative: str) -> str:
    return f'<img alt="{alternative}" src="data:image/png;base64,{base64.b64encode(data).decode()}">'


def _card(card: Card) -> str:
    title, sentence = html.escape(card.title), html.escape(card.sentence)
    link = f"<a class='card {card.verdict}' href='#{_slug(card.title)}'>"
    return f"{link}{_image(card.image, title)}<b>{title}</b>{sentence}</a>"


def to_html(title: str, passed: bool, content: Sequence[Block], heading: str = "Verification report") -> str:
    parts = []
    for block in content:
        if isinstance(block, Table):
            parts.append(block.html())
        elif isinstance(block, Picture):
            caption = html.escape(block.caption)
            image = _image(block.path.read_bytes(), caption)
            parts.append(f"<figure>{image}<figcaption>{caption}</figcaption></figure>\n")
        elif isinstance(block, list):
            parts.append(f"<div class='gallery'>{''.join(map(_card, block))}</div>\n")
        elif block.startswith("#"):
            marks, text = block.split(" ", 1)
            level = f"h{1 + len(marks)}"
            parts.append(f"<{level} id='{_slug(text)}'>{html.escape(text)}</{level}>\n")
        else:
            parts.append(f"<p>{html.escape(block)}</p>\n")
    head = f"<!doctype html><html lang='en'><meta charset='utf-8'><title>{heading}</title>"
    banner = f"<p class='verdict {'passed' if passed else 'failed'}'>{html.escape(title)}</p>"
    return f"{head}<style>{CSS}</style><h1>{heading}</h1>{banner}{''.join(parts)}</html>\n"
