#include "host/study/page_parts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "host/study/pictures.h"

namespace solidcast::study {

std::vector<const Row*> rowsOf(const Study& study, Section section, const std::string& kind,
                               const std::string& family) {
  std::vector<const Row*> found;
  for (const Row& row : study.rows)
    if (row.section == section && (kind.empty() || row.kind == kind) && (family.empty() || row.family == family))
      found.push_back(&row);
  return found;
}

std::vector<std::string> familiesIn(const std::vector<const Row*>& rows) {
  std::vector<std::string> families;
  for (const Row* row : rows)
    if (std::find(families.begin(), families.end(), row->family) == families.end()) families.push_back(row->family);
  return families;
}

std::string wayName(std::size_t way) {
  return std::string("<b style=\"color:") + kWays[way].colour + "\">" + kWays[way].letter + "</b>&#160;" +
         kWays[way].label;
}

std::string grouped(std::uint64_t n) {
  const std::string digits = std::to_string(n);
  std::string s;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) s += ',';
    s += digits[i];
  }
  return s;
}

std::string base64(const std::string& bytes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string s;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) s += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63] : '=';
  }
  return s;
}

std::string familyNote(Section section, const std::string& family) {
  static const std::map<std::string, std::string> rays{
      {"generic", "Solids of size 1, eye and aim around them."},
      {"far", "Eye at 1e3 to 1e6 times the size of the solid."},
      {"tiny", "Size 1e-12 to 1e-3 at distance 1."},
      {"offset", "Solid and eye together 1e7 from the origin."},
      {"length", "Length of the direction 1e-15 to 1e15."},
      {"scaled", "Coordinates (quadric: coefficients) times 1e-30 to 1e30."},
      {"denormal", "Denormal components of origin, direction or coefficients."},
      {"axis", "One or two components of the direction are +0 or -0."},
      {"boundary", "Aimed at the outline, within 16 ulp."},
      {"lattice", "Small integers, aimed exactly at edges, corners, rims, silhouettes."},
      {"rim", "Aimed 1e-8 to 1e-5 (of the size) off an edge or outline."},
      {"surface", "Origin on the surface, or 1e-9 to 1e-3 off it."},
      {"inside", "Origin inside, 1e-9 to 1 below the surface."},
      {"grazing", "Direction 1e-7 to 1e-3 off the plane of the solid."},
      {"face", "Origin in the plane of a face, direction along it or not."},
      {"planet", "Radius 1e6 to 1e8, eye 1 to 2 above the ground."},
      {"sliver", "Sides 1 : 1e3 to 1 : 1e7."},
      {"parallel", "Spans 1e-7 to 1e-3 rad apart."},
      {"spread", "Coefficients over 12 orders of magnitude."},
      {"paraboloid", "Rays 1e-9 to 1e-3 off the axis, some exactly along it."},
      {"generator", "Rays 1e-9 to 1e-4 off a generator of a cone, some parallel to one."},
      {"apex", "Aimed 1e-7 to 1e-1 beside a cone's apex, some exactly at it."},
      {"cylinder", "Tangent to a cylinder, within 16 ulp."}};
  static const std::map<std::string, std::string> pixels{
      {"perspective", "An ordinary perspective picture."},
      {"narrow", "Opening angle of 1e-6 degrees, at the outline."},
      {"wide", "Opening angle of 179.9999 degrees, close above or below the surface."},
      {"far", "Eye at 1e3 to 1e6 times the size of the solid."},
      {"surface", "Eye on the surface, or 1e-9 to 1e-3 off it."},
      {"inside", "Eye inside, 1e-9 to 1 below the surface."},
      {"planet", "Radius 1e6 to 1e8, eye 1 to 2 above the ground."},
      {"orthographic", "An orthographic camera."},
      {"environment", "An environment camera, all around."}};
  const auto& notes = section == Section::pixels ? pixels : rays;
  const auto found = notes.find(family);
  return found == notes.end() ? "" : found->second;
}

std::string table(const std::vector<const Row*>& rows) {
  std::string s =
      "<div class=\"wide\"><table><thead><tr><th>family</th><th>method</th><th>rays</th><th>hits</th><th>p50</th>"
      "<th>p99</th><th>p99.9</th><th>max ulp</th><th>misses</th><th>false hits</th><th>other solid</th>"
      "<th>no number</th><th>wrong near edge</th><th>beyond</th><th>ns, median</th><th>middle half</th><th>host ns</th>"
      "<th>2nd pass</th></tr></thead><tbody>";
  const auto count = [](std::uint64_t n) {
    return n == 0 ? std::string("<td class=\"zero\">0</td>") : "<td class=\"bad\">" + grouped(n) + "</td>";
  };
  std::string last;
  for (const Row* row : rows) {
    const Errors& e = row->errors;
    const Timing& t = row->timing;
    s += std::string(row->family == last ? "<tr>" : "<tr class=\"first\">") + "<th>" +
         (row->family == last ? "" : escaped(row->family)) + "</th><td class=\"way\">" + wayName(row->way) +
         "</td><td>" + grouped(e.rays) + "</td><td>" + grouped(e.agreedHits) + "</td>";
    for (const double v : {e.p50, e.p99, e.p999, e.max}) s += "<td>" + number(v) + "</td>";
    s += count(e.misses) + count(e.falseHits) + count(e.otherSolid) + count(e.notFinite) + count(e.wrongNear) +
         count(e.wrongBeyond);
    const bool exact = kWays[row->way].method == Method::exact;
    s += t.runs == 0 ? "<td>-</td><td>-</td><td>-</td>"
                     : "<td>" + number(t.median) + "</td><td>" + number(t.quarter) + " &#8211; " +
                           number(t.threeQuarters) + "</td><td>" + (exact ? number(t.host) : "-") + "</td>";
    s += "<td>" + (exact ? grouped(t.doubtful) : "-") + "</td></tr>";
    last = row->family;
  }
  return s + "</tbody></table></div>";
}

std::string errorField(const Row& row) {
  const Errors& e = row.errors;
  const std::string title = std::string(kWays[row.way].label) + ", " + row.kind + ", " + row.family + ": max " +
                            number(e.max) + " ulp; wrong " + grouped(e.wrong()) + " of " + grouped(e.rays) + ", " +
                            grouped(e.wrongBeyond) + " beyond an edge";
  const std::string open = "<td title=\"" + escaped(title) + "\" ";
  if (fails(e)) return open + "class=\"fail\">&#10005;</td>";
  const double most = e.agreedHits > 0 ? e.max : 1;
  const bool dark = most > 3e3;
  return open + "style=\"background:" + errorColour(most) + (dark ? ";color:#fff" : "") + "\">" +
         (e.wrong() > 0 ? "&#9651;" : "") + "</td>";
}

std::string caseField(const Row& row) {
  const Errors& e = row.errors;
  if (e.wrong() > 0 || e.notFinite > 0) {
    std::string what = e.rays > 1         ? grouped(e.wrong() + e.notFinite) + " of " + grouped(e.rays) + " wrong"
                       : e.misses > 0     ? "miss"
                       : e.falseHits > 0  ? "false hit"
                       : e.otherSolid > 0 ? "wrong solid"
                                          : "no number";
    return "<td class=\"fail\">&#10005; " + what + "</td>";
  }
  if (e.agreedHits == 0) return "<td>right</td>";
  const std::string colour = errorColour(e.max);
  return "<td style=\"background:" + colour + (e.max > 3e3 ? ";color:#fff" : "") + "\">" + number(e.max) + "</td>";
}

std::string methodsKey() {
  std::string s = "<ul class=\"legend\">";
  for (std::size_t way = 0; way < kWayCount; ++way)
    s += "<li>" + legendMark(0, kWays[way].colour) + " " + wayName(way) + "</li>";
  return s + "</ul>";
}

std::string colourKey() {
  std::string s = "<p class=\"colours\">";
  for (const auto& [ulps, label] : {std::pair{1.0, "&#8804; 1 ulp"},
                                    {10.0, "10"},
                                    {1e2, "10&#178;"},
                                    {1e3, "10&#179;"},
                                    {1e4, "10&#8308;"},
                                    {1e5, "10&#8309;"},
                                    {1e6, "&#8805; 10&#8310;"}})
    s +=
        "<span style=\"background:" + errorColour(ulps) + (ulps > 3e3 ? ";color:#fff" : "") + "\">" + label + "</span>";
  return s + "<span class=\"fail\">&#10005; wrong</span></p>";
}

std::string styleSheet() {
  return R"(
:root{color-scheme:light}
body{font:16px/1.5 system-ui,"Segoe UI","Helvetica Neue",Arial,sans-serif;color:#1d2430;background:#fff;max-width:1180px;margin:0 auto;padding:24px 20px 80px}
h1{font-size:34px;margin:0 0 4px;letter-spacing:-.01em}h2{font-size:24px;margin:48px 0 8px;padding-top:12px;border-top:2px solid #1d2430}
h3{font-size:18px;margin:28px 0 6px}p{max-width:78ch}.lead{font-size:19px;color:#44506a;margin:0 0 16px}
.facts{display:grid;grid-template-columns:max-content 1fr;gap:2px 16px;font-size:14px;margin:0}.facts dt{color:#667}.facts dd{margin:0}
nav{margin:20px 0 0}nav a{margin-right:14px;color:#0b5394}
.plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(350px,1fr));gap:18px}
figure{margin:0;border:1px solid #dde1e8;border-radius:6px;padding:8px;background:#fff}figure img{width:100%;image-rendering:auto;display:block}
figcaption{font-size:13px;color:#556;line-height:1.35;padding:4px 4px 0}
.plot{width:100%;height:auto;display:block;font:11px system-ui,"Segoe UI",Arial,sans-serif}
.plot .title{font-size:14px;font-weight:600;fill:#1d2430}.plot .tick{fill:#556;font-size:10.5px}.plot .power{font-size:7.5px}
.plot .label{fill:#1d2430;font-size:11px}.plot .letter{font-weight:700;font-size:12px;paint-order:stroke;stroke:#fff;stroke-width:2.5px}
.grid{stroke:#e6e9ef;stroke-width:1}.one{stroke:#1d2430;stroke-width:1.2}.axis{stroke:#99a;stroke-width:1}.lane{stroke:#f6dada;stroke-width:18}
.reach{stroke-width:2;stroke-opacity:.65}.spread{stroke-width:3;stroke-opacity:.55}.front{fill:none;stroke:#aab;stroke-width:1.4;stroke-dasharray:5 3}
.mark{stroke:#fff;stroke-width:1.4}.cross{fill:none;stroke-width:3}.crossback{fill:none;stroke:#fff;stroke-width:6}
.curve{fill:none;stroke-opacity:.85}.curve.most{stroke-width:1.4;stroke-dasharray:2 3}
.key{width:18px;height:18px;vertical-align:-4px}.legend{list-style:none;padding:0;display:flex;flex-wrap:wrap;gap:4px 22px;margin:6px 0}
table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums;margin:8px 0}th,td{padding:3px 8px;text-align:right}
thead th{border-bottom:1px solid #99a;vertical-align:bottom;font-weight:600}tbody th{text-align:left;font-weight:600}tr.first>*{border-top:1px solid #dde1e8}
th.words,.words{text-align:left}.words b{white-space:nowrap}table .way{white-space:nowrap;text-align:left}.zero{color:#aab}.bad{font-weight:600}.fail{background:#e60014;color:#fff}.wide{overflow-x:auto}
.map td{width:15px;min-width:15px;padding:1px 0;text-align:center;border:1px solid #e1e5ec;font-size:12px}.map .none{border:none}
.map thead th{padding:1px 0;text-align:center;font-size:12px}.map thead tr:first-child th{border:none;padding:2px 6px}
.cases td,.cases th{border-bottom:1px solid #eceff4}.colours span{display:inline-block;font-size:12px;padding:1px 9px;border:1px solid #dde1e8}
.wrong{color:#e60014}details summary{cursor:pointer;margin:10px 0;color:#0b5394}
@media print{figure{break-inside:avoid}}
)";
}

}  // namespace solidcast::study
