"""Puts the parts together: report.md with its pictures beside it, and report.html, one file with all in it."""

import base64
import html
import re
import shutil
from pathlib import Path

import markdown

from report import machine, tables, words
from report.job import is_quick

HEAD = """# qdist: the report

*How deep is this point, body or grasp inside that set, and how sure are we?* Every answer of qdist is a bracket: the truth is between its ends. This page shows what
that costs, beside the libraries that people know, and where it breaks or loses. Every number on it was measured by one command, `./x report`, but for those that the last
part quotes from two papers, which says so. {files} What its words mean is told [first](#words).
"""
# Where the tables are that the page and its pictures are made of.
FILES = "The tables behind the pictures are CSV files in a folder a part."
COPIED = "The tables behind the pictures are CSV files beside it; what is drawn of single runs (energy over time, a query that is cut off) is in the folder that the command makes."

QUICK = "*Quick: few and small runs. Figures are rough.*"

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>qdist: the report</title>
<style>
:root {{ color-scheme: light; }}
body {{ font: 16px/1.55 system-ui, sans-serif; color: #1b1f24; background: #fff; max-width: 62rem; margin: 0 auto; padding: 1rem 1.2rem 4rem; }}
h1, h2, h3 {{ line-height: 1.25; margin: 2.2em 0 .6em; }}
h1 {{ margin-top: 1em; }}
h2 {{ border-top: 1px solid #d0d7de; padding-top: 1em; }}
figure {{ margin: 1.2em 0; }}
figure svg, figure img {{ max-width: 100%; min-width: 42rem; height: auto; }}
figure, .wide {{ overflow-x: auto; }}
table {{ border-collapse: collapse; font-size: .92em; font-variant-numeric: tabular-nums; }}
th, td {{ padding: .25em .7em; border-bottom: 1px solid #d8dee4; vertical-align: bottom; white-space: nowrap; }}
#words + .wide td {{ vertical-align: top; white-space: normal; }}
#words + .wide td:first-child {{ min-width: 9em; }}
table + p {{ margin-top: 1.2em; }}
code, pre {{ background: #f3f5f7; border-radius: 4px; font-size: .92em; }}
code {{ padding: .1em .3em; }}
pre {{ padding: .7em 1em; overflow-x: auto; }}
pre code {{ padding: 0; }}
nav ul {{ columns: 2; padding-left: 1.2em; }}
@media (max-width: 40rem) {{ nav ul {{ columns: 1; }} body {{ font-size: 15px; }} }}
</style>
</head>
<body>
{body}
</body>
</html>
"""


def write(out, parts):
    out = Path(out)
    folders = [out / part for part in parts if (out / part / "part.md").exists()]
    texts = [(folder / "part.md").read_text() for folder in folders]
    heads = [re.search(r"^## (.*)$", text, re.M).group(1) for text in texts]
    quick = [is_quick(folder) for folder in folders]
    note = f"\n{QUICK}\n" if any(quick) and all(quick) else ""
    if any(quick) and not note:
        texts = [re.sub(r"^(## .*)$", rf"\1\n\n{QUICK}", text, count=1, flags=re.M) if rough else text for text, rough in zip(texts, quick)]
    contents = "\n".join(f"* [{head}](#{anchor(head)})" + (", quick" if rough else "") for head, rough in zip(heads, quick))
    where = tables.table(["", "measured with"], machine.rows(), ["---", "---"])
    text = "\n".join([HEAD.format(files=FILES) + note, contents, "", words.words(), *texts, "## Where this was measured\n", where])
    (out / "report.md").write_text(text)
    (out / "report.html").write_text(PAGE.format(body=inlined(out, text)))


def publish(out, parts, folder, tables):
    """The copy that is committed: Markdown, pictures as PNG, and the tables that figures elsewhere are checked with."""
    folder.mkdir(parents=True, exist_ok=True)
    for file in folder.iterdir():
        file.unlink()
    text = (Path(out) / "report.md").read_text().replace(FILES, COPIED)
    for file, ending in sorted(set(re.findall(r"\]\(([\w-]+/[\w-]+)\.(svg|png)\)", text))):
        name = file.replace("/", "-") + ".png"
        shutil.copyfile(Path(out) / f"{file}.png", folder / name)
        text = text.replace(f"]({file}.{ending})", f"]({name})")
    for part, table in tables:
        if part in parts and (Path(out) / part / table).exists():
            shutil.copyfile(Path(out) / part / table, folder / table)
    (folder / "report.md").write_text(text)


def anchor(head):
    """The anchor that Markdown readers give a heading."""
    return re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-")


def inlined(out, text):
    """The page's body: Markdown as HTML, with the pictures in it."""
    slug = lambda value, _: anchor(value)
    body = markdown.markdown(text, extensions=["tables", "fenced_code", "toc"], extension_configs={"toc": {"slugify": slug}})
    body = re.sub(r'<p><img alt="([^"]*)" src="([^"]*)" ?/></p>', lambda match: figure(out, *match.groups()), body)
    return body.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")


def figure(out, what, file):
    path = out / file
    what = html.escape(html.unescape(what), quote=True)
    if path.suffix == ".svg":
        svg = path.read_text()
        svg = svg[svg.index("<svg") :].replace("<svg", f'<svg role="img" aria-label="{what}"', 1)
        return f"<figure>{own_names(svg, file)}</figure>"
    data = base64.b64encode(path.read_bytes()).decode()
    return f'<figure><img alt="{what}" src="data:image/{path.suffix[1:]};base64,{data}"></figure>'


def own_names(svg, file):
    """Pictures of one page must not share the names of their elements."""
    prefix = re.sub(r"\W", "-", file) + "-"
    svg = re.sub(r'\bid="([^"]*)"', rf'id="{prefix}\1"', svg)
    svg = re.sub(r'href="#([^"]*)"', rf'href="#{prefix}\1"', svg)
    return re.sub(r"url\(#([^)]*)\)", rf"url(#{prefix}\1)", svg)
