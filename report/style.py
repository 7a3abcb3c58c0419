"""The style sheet of the pages: light and dark, from a phone's width to paper. Colours also differ in lightness."""

from __future__ import annotations

_LIGHT = """
--bg: #fff; --ink: #1c2128; --mute: #57606a; --rule: #d8dee4; --card: #f6f8fa;
--good: #00785a; --fair: #8a5a00; --bad: #c2410c;
--a: #0072b2; --b: #d55e00; --c: #00785a; --d: #8250a8; --e: #6e7781; --table: #e9dfcb; --edge: #e08214;
"""
_DARK = """
--bg: #0d1117; --ink: #e6edf3; --mute: #9da7b1; --rule: #30363d; --card: #161b22;
--good: #35c79a; --fair: #e3b341; --bad: #ff8a57;
--a: #58aef5; --b: #ff9a4d; --c: #35c79a; --d: #c297ff; --e: #8b949e; --table: #3a3325; --edge: #e08214;
"""
_PAGE = """
* { box-sizing: border-box }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 74rem; margin: 0 auto; padding: 1.2rem 1rem 3rem;
  color: var(--ink); background: var(--bg); overflow-wrap: anywhere }
h1 { font-size: 1.4rem; margin: 0 }
h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; border-bottom: 1px solid var(--rule) }
h3 { font-size: .95rem; margin: 0 0 .3rem }
p { margin: .3rem 0 .8rem }
.mute, figcaption { color: var(--mute) }
.tiles, .cards { display: grid; gap: .8rem; margin: .9rem 0 }
.tiles { grid-template-columns: repeat(auto-fit, minmax(min(100%, 15rem), 1fr)) }
.cards { grid-template-columns: repeat(auto-fill, minmax(min(100%, 20.5rem), 1fr)) }
.cards.small { grid-template-columns: repeat(auto-fill, minmax(min(100%, 14rem), 1fr)) }
.tile, figure { background: var(--card); border: 1px solid var(--rule); border-radius: 8px; padding: .7rem .8rem;
  margin: 0; break-inside: avoid }
.tile { border-left: 6px solid var(--rule) }
.tile b { display: block; font-size: 1.55rem; line-height: 1.25 }
.tile span { font-size: .85rem }
.tile.good { border-left-color: var(--good) } .tile.good b { color: var(--good) }
.tile.fair { border-left-color: var(--fair) } .tile.fair b { color: var(--fair) }
.tile.bad { border-left-color: var(--bad) } .tile.bad b { color: var(--bad) }
figcaption { font-size: .8rem; line-height: 1.4 }
figure img { width: 100%; height: auto; border-radius: 4px; display: block }
.wide { overflow-x: auto }
table { border-collapse: collapse; margin: .4rem 0; font-size: .9rem }
td, th { border-bottom: 1px solid var(--rule); padding: .25rem .9rem .25rem 0; text-align: left; vertical-align: top;
  overflow-wrap: normal }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums }
th { color: var(--mute); font-weight: 600 }
pre { font-size: 12px; overflow-x: auto; white-space: pre-wrap }
summary { cursor: pointer; color: var(--a) }
"""
_CHARTS = """
svg { width: 100%; height: auto; display: block }
svg text { font-size: 11px; fill: var(--mute) }
svg .name { text-anchor: middle }
.grid { stroke: var(--rule); stroke-width: .7; fill: none }
.line { fill: none; stroke-width: 1.8; stroke-linejoin: round }
.thin { stroke-width: 1; opacity: .75 }
.dashed { stroke-dasharray: 5 4 }
.area.a, .area.b { opacity: .75 }
.band { opacity: .22 }
.cells { image-rendering: pixelated }
.key { display: inline-block; margin-right: .9rem }
.key i { display: inline-block; width: 1.3em; height: .75em; margin-right: .35em }
.key i.dashed { height: 0; border-top: 2px dashed; vertical-align: middle }
"""
_PAPER = """
@page { size: A4; margin: 13mm }
* { print-color-adjust: exact; -webkit-print-color-adjust: exact }
body { padding: 0; max-width: none; font-size: 10.5pt }
h2, h3 { break-after: avoid }
h2 { margin-top: 1.3rem }
.cards { grid-template-columns: repeat(2, 1fr) }
.tiles, .cards.small { grid-template-columns: repeat(4, 1fr) }
.tile b { font-size: 1.2rem }
tr { break-inside: avoid }
table { font-size: .8rem }
td, th { padding-right: .6rem }
details::details-content { content-visibility: visible; display: block }
pre { display: none }
"""
_VARIABLES = ("a", "b", "c", "d", "e", "good", "fair", "bad", "ink", "table", "edge")
_COLOURS = {
    **{name: f"var(--{name})" for name in _VARIABLES},
    "left": "#1f77b4",
    "right": "#f29e38",
    "slow": "#a5c9e1",
    "yellow": "#fde725",
    "violet": "#440154",
    "object": "#2e8b57",
}
"""Mark -> colour, of lines, dots, areas and keys alike."""


def _marks() -> str:
    return "".join(
        f".line.{name} {{ stroke: {colour} }} .dot.{name}, .area.{name}, .band.{name} {{ fill: {colour} }} "
        f".key i.{name} {{ background: {colour}; border-color: {colour} }}\n"
        for name, colour in _COLOURS.items()
    )


STYLE = (
    f":root {{ color-scheme: light dark; {_LIGHT} }}\n"
    f"@media screen and (prefers-color-scheme: dark) {{ :root {{ {_DARK} }} }}\n"
    f"{_PAGE}{_CHARTS}{_marks()}.key i.dashed {{ background: none }}\n@media print {{ {_PAPER} }}"
)
