# The site made of these pages: script/site runs Sphinx with this.
import pathlib

project = "weft"
copyright = "the weft maintainers, MIT licence"
extensions = ["myst_parser"]
myst_heading_anchors = 4  # "## The map" is #the-map, as where these pages are shown as they are
exclude_patterns = []
suppress_warnings = ["misc.highlighting_failure"]  # JSON with comments is shown plainly
html_theme = "furo"
html_title = "weft"
html_copy_source = False
html_show_sphinx = False

# What stands in the sidebar, in this order; a page that is not named comes at the end of the last part, and a name
# without a page is passed over.
parts = {
    "First": ["getting-started", "cloth", "engines", "charlie", "sources"],
    "Catalogue": ["lobes", "terms", "layers", "workflows", "profiles"],
    "The program": ["cli", "view", "materials", "chart", "gltf", "images", "render", "raster", "check", "bake", "diff",
                    "export", "plots", "match", "rosetta", "fit", "doctor", "weave"],
    "The library": ["library", "reference", "adding-a-lobe", "architecture", "glossary"],
    "How it works": ["fibre", "weave-model", "weave-evidence", "dust", "ltc", "area-lights", "environment", "cost"],
}


def toctree(caption, pages):
    return "\n".join(["", "```{toctree}", ":hidden:", f":caption: {caption}", "", *pages, "```", ""])


def contents(app, name, source):
    """Gives index.md the parts, and the page of a kind of the catalogue what is in its folder."""
    folder = pathlib.Path(app.srcdir)
    if name == "index":
        named = {page for pages in parts.values() for page in pages} | {"index"}
        rest = sorted(p.stem for p in folder.glob("*.md") if p.stem not in named)
        last = list(parts)[-1]
        for caption, pages in parts.items():
            there = [page for page in pages if (folder / f"{page}.md").exists()]
            source[0] += toctree(caption, there + (rest if caption == last else []))
    elif (folder / name).is_dir():
        pages = sorted(f"{name}/{p.stem}" for p in (folder / name).glob("*.md"))
        if pages:
            source[0] += toctree(name, pages)


def setup(app):
    app.connect("source-read", contents)
