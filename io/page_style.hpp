// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace sunder {

/// The style of a report page: light, dark, narrow, paper. Colours c0 … c9 are those of lines.
inline constexpr char kPageStyle[] = R"css(
:root{color-scheme:light dark;--paper:#fbfbf9;--sheet:#fff;--ink:#1b2430;--soft:#5b6673;--rule:#e2e4e0;
--accent:#0f5e73;--good:#1c6b45;--good-bg:#e2f2e8;--bad:#8f3208;--bad-bg:#fdeadd;--open-bg:#eceeec;
--c0:#0072b2;--c1:#d55e00;--c2:#009e73;--c3:#b5387f;--c4:#8a6d00;--c5:#2ca5d8;--c6:#6a51a3;--c7:#7f6a5c;
--c8:#c42b2b;--c9:#56606b}
@media (prefers-color-scheme:dark){:root{--paper:#12161b;--sheet:#191f26;--ink:#e6e9ec;--soft:#9aa6b2;
--rule:#2c353f;--accent:#6cc4dc;--good:#86d7ab;--good-bg:#173226;--bad:#ffb083;--bad-bg:#3b2113;
--open-bg:#28313a;--c0:#4fa8e0;--c1:#f28c3a;--c2:#3cc79b;--c3:#e583bb;--c4:#d9bd45;--c5:#86d3f5;
--c6:#a995e0;--c7:#b8a393;--c8:#f07070;--c9:#9aa6b2}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);
font:15px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue","Noto Sans",Arial,sans-serif;
font-variant-numeric:tabular-nums;-webkit-text-size-adjust:100%}
main{max-width:1120px;margin:0 auto;padding:40px 28px 8px}
header{border-bottom:3px solid var(--ink);padding-bottom:20px}
.kind{margin:0;color:var(--soft);font-size:13px;letter-spacing:.04em}
.kind b{color:var(--accent);letter-spacing:0;margin-right:.35em}
h1{font-size:38px;line-height:1.15;letter-spacing:-.02em;margin:4px 0 12px;overflow-wrap:anywhere}
h2{font-size:21px;line-height:1.25;letter-spacing:-.01em;margin:0 0 6px}
h3{font-size:15px;margin:0}
p{margin:0 0 10px;max-width:76ch}
.lede{font-size:18px;line-height:1.5;max-width:68ch;overflow-wrap:anywhere}
.facts{display:flex;flex-wrap:wrap;gap:6px 28px;margin:16px 0 0}
.facts div{display:flex;gap:.5em}
.facts dt{color:var(--soft)}
.facts dd{margin:0;overflow-wrap:anywhere}
.notice{margin:24px 0 0;padding:14px 18px;background:var(--bad-bg);border-left:4px solid var(--bad)}
.notice h2{font-size:15px;color:var(--bad)}
.notice ul{margin:0;padding-left:1.2em}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(160px,1fr));margin:28px 0 0;
border-bottom:1px solid var(--rule)}
.tiles div{padding:0 16px 18px 0;margin-bottom:0}
.tiles span{display:block}
.label{color:var(--soft);font-size:13px}
.value{font-size:30px;line-height:1.25;font-weight:600;letter-spacing:-.02em;white-space:nowrap}
.note{font-size:13px;color:var(--soft)}
section{padding:34px 0 6px}
section>p{color:var(--soft)}
.figures{display:grid;grid-template-columns:repeat(2,minmax(0,1fr));gap:20px;margin:16px 0 0}
figure{margin:0;background:var(--sheet);border:1px solid var(--rule);border-radius:6px;
padding:14px 16px 12px;display:flex;flex-direction:column;min-width:0}
figcaption{margin-bottom:8px}
figcaption p{margin:2px 0 0;color:var(--soft);font-size:13px}
figure .plot{margin-top:auto}
.plot{display:block;width:100%;height:auto;overflow:visible}
.plot text{font-size:12px;fill:var(--soft)}
.plot line{stroke:var(--rule);stroke-width:1}
.plot .axis{stroke:var(--soft)}
.plot .mark{stroke:var(--bad);stroke-width:1.2;stroke-dasharray:5 4}
.plot .line{fill:none;stroke-width:1.8;stroke-linejoin:round;stroke-linecap:round}
.plot .area{opacity:.13;stroke:none}
.legend{list-style:none;display:flex;flex-wrap:wrap;gap:2px 16px;margin:6px 0 0;padding:0;font-size:13px}
.legend i{display:inline-block;width:14px;height:3px;border-radius:2px;margin-right:6px;vertical-align:3px}
polyline.c0{stroke:var(--c0)}polyline.c1{stroke:var(--c1)}polyline.c2{stroke:var(--c2)}
polyline.c3{stroke:var(--c3)}polyline.c4{stroke:var(--c4)}polyline.c5{stroke:var(--c5)}
polyline.c6{stroke:var(--c6)}polyline.c7{stroke:var(--c7)}polyline.c8{stroke:var(--c8)}
polyline.c9{stroke:var(--c9)}
polygon.c0{fill:var(--c0)}polygon.c1{fill:var(--c1)}polygon.c2{fill:var(--c2)}polygon.c3{fill:var(--c3)}
polygon.c4{fill:var(--c4)}polygon.c5{fill:var(--c5)}polygon.c6{fill:var(--c6)}polygon.c7{fill:var(--c7)}
polygon.c8{fill:var(--c8)}polygon.c9{fill:var(--c9)}
i.c0{background:var(--c0)}i.c1{background:var(--c1)}i.c2{background:var(--c2)}i.c3{background:var(--c3)}
i.c4{background:var(--c4)}i.c5{background:var(--c5)}i.c6{background:var(--c6)}i.c7{background:var(--c7)}
i.c8{background:var(--c8)}i.c9{background:var(--c9)}
.bar{display:block;height:8px;border-radius:2px;min-width:1px}
.table{overflow-x:auto;margin:10px 0 12px}
table{border-collapse:collapse;width:100%;font-size:14px}
th{font-weight:600;text-align:left;color:var(--soft);font-size:13px;border-bottom:1px solid var(--ink);
white-space:nowrap}
th,td{padding:6px 18px 6px 0;vertical-align:top}
th:last-child,td:last-child{padding-right:0}
td{border-bottom:1px solid var(--rule)}
tbody tr:last-child td{border-bottom:0}
.t2{max-width:640px}
.t3{max-width:900px}
.n{text-align:right;white-space:nowrap}
.l{white-space:nowrap}
.w{min-width:16em}
.b{width:30%;min-width:64px;vertical-align:middle}
figure td{padding-top:4px;padding-bottom:3px;line-height:1.35}
figure .w{min-width:0}
figure .table{margin:0}
figure th{padding-top:0}
td small{display:block;color:var(--soft);font-size:13px}
.badge{display:inline-block;padding:0 8px;border-radius:10px;font-size:12.5px;line-height:20px;
white-space:nowrap;background:var(--open-bg);color:var(--soft)}
.badge.good{background:var(--good-bg);color:var(--good)}
.badge.bad{background:var(--bad-bg);color:var(--bad);font-weight:600}
details{margin:4px 0 12px}
summary{cursor:pointer;color:var(--accent);padding:4px 0}
pre{background:var(--sheet);border:1px solid var(--rule);border-radius:6px;padding:12px 16px;margin:10px 0 14px;
white-space:pre-wrap;overflow-wrap:anywhere}
code,.mono{font:13px/1.5 ui-monospace,"SF Mono",Menlo,Consolas,"DejaVu Sans Mono",monospace}
footer{max-width:1120px;margin:26px auto 0;padding:14px 28px 36px;color:var(--soft);font-size:13px;
border-top:1px solid var(--rule)}
@media screen and (max-width:760px){main{padding:24px 16px 0}footer{padding:14px 16px 28px}h1{font-size:28px}
.lede{font-size:16px}.figures{grid-template-columns:minmax(0,1fr);gap:14px}
.tiles{grid-template-columns:repeat(2,minmax(0,1fr))}.value{font-size:24px}figure{padding:12px}
.plot text{font-size:15px}th,td{padding-right:12px}.w{min-width:9em}}
@media print{:root{--paper:#fff}body{font-size:11px}main{max-width:none;padding:0}h1{font-size:26px}
.lede{font-size:13px}.value{font-size:18px}.tiles{grid-template-columns:repeat(auto-fit,minmax(105px,1fr))}
h2{font-size:15px}h3{font-size:12px}.badge{font-size:10px;line-height:15px}.figures{gap:10px}
.plot text{font-size:15px}table{font-size:11px}td small,th,.label,.note,figcaption p,.legend{font-size:10px}
th,td{padding:3px 12px 3px 0}section{padding:18px 0 0}figure,tr,.notice{break-inside:avoid}
h2,figcaption{break-after:avoid}*{-webkit-print-color-adjust:exact;print-color-adjust:exact}}
)css";

}  // namespace sunder
