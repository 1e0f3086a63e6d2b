#pragma once
#include <string_view>

namespace bernal {

/// The style sheet of report.html, light and dark.
inline constexpr std::string_view report_style = R"css(
:root { color-scheme: light dark; --ink:#1d2733; --dim:#5d6b7a; --rule:#dde3e9; --page:#ffffff; --card:#f5f7f9;
  --first:#2f8ba3; --second:#3a3f8f; --yes:#14804a; --short:#b36b00; --no:#c0322b; }
@media (prefers-color-scheme: dark) { :root { --ink:#e4e9ee; --dim:#94a2b1; --rule:#2c3743; --page:#10161d;
  --card:#18212b; --first:#5cc6c4; --second:#a9a7f0; --yes:#4cc38a; --short:#e3b341; --no:#ff7b72; } }
* { box-sizing:border-box; }
body { margin:0; background:var(--page); color:var(--ink); font:16px/1.5 system-ui,sans-serif; }
main { max-width:1120px; margin:0 auto; padding:32px 24px 64px; }
h1 { font-size:26px; font-weight:650; margin:0 0 2px; letter-spacing:-.01em; }
h2 { font-size:18px; font-weight:650; margin:44px 0 6px; }
p { margin:6px 0 12px; max-width:75ch; }
.dim, small, caption { color:var(--dim); }
.cards { display:grid; grid-template-columns:repeat(auto-fit,minmax(190px,1fr)); gap:12px; margin:22px 0; }
.card { background:var(--card); border-radius:10px; padding:14px 16px; }
.card b { display:block; font-size:26px; font-weight:650; line-height:1.25; font-variant-numeric:tabular-nums; }
.card small { display:block; line-height:1.35; margin-top:4px; }
.yes { color:var(--yes); } .short { color:var(--short); } .no { color:var(--no); }
.statement { border-left:4px solid var(--yes); background:var(--card); padding:12px 16px; border-radius:0 10px 10px 0;
  max-width:none; }
.statement.short { border-color:var(--short); color:var(--ink); } .statement.short b { color:var(--short); }
.statement.failed { border-color:var(--no); }
.picture svg { display:block; width:100%; max-height:min(78vh,760px); margin:20px auto; }
.pair { display:grid; grid-template-columns:repeat(auto-fit,minmax(min(440px,100%),1fr)); gap:28px; align-items:start; }
.wide { overflow-x:auto; }
table { border-collapse:collapse; width:100%; font-variant-numeric:tabular-nums; font-size:15px; }
caption { text-align:left; padding:0 0 6px; }
th { text-align:left; font-weight:600; color:var(--dim); }
th,td { padding:6px 14px 6px 0; border-bottom:1px solid var(--rule); vertical-align:top; }
th:last-child,td:last-child { padding-right:0; }
td:first-child { white-space:nowrap; }
.n { text-align:right; white-space:nowrap; }
.chart { width:100%; height:auto; display:block; }
.chart text { font:12px system-ui,sans-serif; fill:var(--dim); }
.chart .label { fill:var(--ink); }
.chart .grid { stroke:var(--rule); }
.chart .axis { stroke:var(--dim); }
.chart .stage { stroke:var(--dim); stroke-dasharray:2 4; }
.chart .bar { fill:var(--first); opacity:.75; }
.chart .line { fill:none; stroke-width:2; stroke-linejoin:round; }
.chart .first { stroke:var(--first); } .chart .second { stroke:var(--second); }
.chart .asked { stroke:var(--ink); stroke-width:1.5; stroke-dasharray:3 3; }
.chart .band { fill:var(--first); opacity:.25; }
.chart .point { fill:var(--first); }
.key i { display:inline-block; width:14px; height:10px; margin:0 6px 0 14px; border-radius:2px; }
.key i:first-child { margin-left:0; }
.key .dashed { height:0; border-top:2px dashed var(--ink); border-radius:0; vertical-align:middle; }
pre { background:var(--card); border-radius:10px; padding:14px 16px; overflow-x:auto; font:14px/1.45 ui-monospace,monospace; }
summary { cursor:pointer; color:var(--dim); margin:8px 0; }
code { font:.92em ui-monospace,monospace; overflow-wrap:anywhere; }
)css";

}  // namespace bernal
