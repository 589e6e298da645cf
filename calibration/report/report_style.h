#pragma once

namespace nadir::calibration {

// How a report looks: colours by role, in light, in dark and on paper.

inline constexpr const char* kReportStyle = R"css(
:root { --paper: #ffffff; --sheet: #f5f6f8; --ink: #1d2430; --quiet: #5b6675; --line: #d9dee5;
  --grid: #e8ebf0; --bar: #7fa7d6; --curve: #c2410c; --hot: #c2261a; --arrow: #2c4a7c;
  --covered: #dcebdc; --pass: #1b7f45; --warn: #b45f06; --fail: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --paper: #14181f; --sheet: #1c222b; --ink: #e6eaf0;
  --quiet: #a0abba; --line: #39424f; --grid: #2a313b; --bar: #4f7db3; --curve: #ff9d5c;
  --hot: #ff7d70; --arrow: #a9c4ee; --covered: #24402f; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 15px/1.45 "Helvetica Neue", Helvetica, Arial, "DejaVu Sans", sans-serif; }
main { width: 1160px; margin: 0 auto; padding: 28px 0 40px; }
header { display: flex; align-items: center; gap: 22px; }
h1 { font-size: 24px; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 16px; margin: 0 0 8px; }
p { margin: 4px 0 0; color: var(--quiet); }
.grade { font-size: 26px; font-weight: 700; color: #ffffff; padding: 10px 20px; border-radius: 8px;
  letter-spacing: 0.04em; }
.pass { background: var(--pass); } .warn { background: var(--warn); }
.fail { background: var(--fail); }
.facts { display: grid; grid-template-columns: repeat(6, 1fr); gap: 12px; margin: 22px 0 16px; }
.fact { background: var(--sheet); border-radius: 8px; padding: 12px 14px; }
.fact b { font-size: 23px; } .fact .unit { color: var(--quiet); }
.fact span:last-child { display: block; color: var(--quiet); font-size: 13px; }
.findings { list-style: none; margin: 0 0 8px; padding: 0; }
.findings li { padding: 7px 0; border-top: 1px solid var(--line); }
.mark { color: #ffffff; border-radius: 4px; padding: 1px 8px; font-size: 13px; margin-right: 6px; }
.figures, .tables { display: grid; grid-template-columns: 1fr 1fr; gap: 26px 40px; margin-top: 22px; }
.tables { grid-template-columns: 5fr 6fr; align-items: start; }
figure { margin: 0; break-inside: avoid; }
figcaption, .quiet { color: var(--quiet); font-size: 13px; }
figcaption { padding-left: 62px; max-width: 500px; }
table { border-collapse: collapse; width: 100%; font-size: 14px; font-variant-numeric: tabular-nums; }
th { text-align: right; color: var(--quiet); font-weight: 500; padding: 4px 8px; vertical-align: bottom; }
td { text-align: right; padding: 4px 8px; border-top: 1px solid var(--line); }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
tr.used td { font-weight: 700; }
svg { display: block; max-width: 100%; height: auto; }
svg text { font-size: 12px; fill: var(--ink); } svg text.quiet { fill: var(--quiet); }
svg .label { fill: var(--hot); font-weight: 600; paint-order: stroke; stroke: var(--paper);
  stroke-width: 3px; stroke-linejoin: round; }
.frame { fill: none; stroke: var(--quiet); } .grid { stroke: var(--grid); }
.arrow { fill: none; stroke: var(--arrow); stroke-width: 1.2; }
.arrow.hot { stroke: var(--hot); stroke-width: 1.8; }
.bar { fill: var(--bar); stroke: var(--paper); stroke-width: 0.5; }
.curve { fill: none; stroke: var(--curve); stroke-width: 2.2; }
.cell { shape-rendering: crispEdges; }
.hull { fill: none; stroke: #ffffff; stroke-width: 1.6; stroke-dasharray: 6 4; }
.hull.shadow { stroke: #000000; stroke-opacity: 0.4; stroke-width: 3.4; stroke-dasharray: none; }
.hull.dark { stroke: var(--ink); stroke-width: 1.3; }
.speck { fill: #ffffff; fill-opacity: 0.75; } .point { fill: var(--arrow); }
.covered { fill: var(--covered); stroke: var(--paper); }
.empty { fill: url(#hatch); stroke: var(--paper); }
#hatch path { stroke: var(--warn); stroke-width: 1.4; opacity: 0.55; }
@media print { :root { --paper: #ffffff; --sheet: #f5f6f8; --ink: #000000; --quiet: #444444;
  --line: #bbbbbb; --grid: #dddddd; --bar: #7fa7d6; --curve: #c2410c; --hot: #c2261a;
  --arrow: #2c4a7c; --covered: #dcebdc; }
  body { print-color-adjust: exact; -webkit-print-color-adjust: exact; } main { padding: 0; }
  .tables > div { break-inside: avoid; } @page { size: A4 landscape; margin: 10mm; } }
)css";

/// Patterns that the figures fill with.
inline constexpr const char* kReportPatterns =
    "<svg width=\"0\" height=\"0\" style=\"position:absolute\"><defs><pattern id=\"hatch\" "
    "width=\"7\" height=\"7\" patternUnits=\"userSpaceOnUse\"><path d=\"M0 7L7 0\"/></pattern>"
    "</defs></svg>\n";

}  // namespace nadir::calibration
