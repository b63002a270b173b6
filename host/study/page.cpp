// study.html: one page, everything in it, for a reader who knows nothing of the project.
#include <algorithm>
#include <cmath>
#include <map>

#include "host/study/page_parts.h"

namespace solidcast::study {
namespace {

/// What a way may promise, in words and numbers (docs/numerics.md proves or measures them).
const char* promiseOf(const Way& way) {
  if (way.method == Method::naive) return "none: textbook formulas in fp32, kept as the yardstick";
  if (way.method == Method::fast) return "none: fp32 prepared for speed; good on scenes of moderate size";
  return "the right solid, the right hit or miss, t within 1 ulp; what its first pass cannot decide is decided again "
         "in "
         "higher precision on the host";
}

std::string head(const Study& study) {
  std::string s =
      "<header><h1>Error against run time</h1><p class=\"lead\">How exactly, and how fast, each method of "
      "solidcast casts rays at solids. Every single answer on this page was compared with the true one, found "
      "in exact arithmetic.</p><dl class=\"facts\">";
  const auto fact = [&](const char* name, const std::string& value) {
    s += std::string("<dt>") + name + "</dt><dd>" + escaped(value) + "</dd>";
  };
  fact("Command", study.command);
  fact("Program", "solidcast " + study.version);
  fact("Device", study.device.name + " (" + study.device.type + ")");
  fact("Driver", study.device.driver + ", " + study.device.driverInfo + ", Vulkan " + study.device.apiVersion);
  fact("Arithmetic, as probed", study.arithmetic32);
  fact("", study.arithmetic64);
  fact("Measured", std::to_string(study.rows.size()) + " rows in " + number(std::round(study.seconds)) + " s" +
                       (study.complete ? "" : "; the study was interrupted"));
  return s + "</dl></header>";
}

std::string howToRead() {
  std::string s =
      R"(<section><h2>How to read the plots</h2><p>Each plot is one kind of difficulty. <b>To the left is more
exact, further down is faster.</b> A method is a line along the axis of error: it starts at the error that half of all hits
stay below (the median), its small dots are what 99 % and 99.9 % stay below, and it ends with a large mark at the
largest error. Errors are of the distance t along the ray, counted in <i>ulp</i>: the spacing of neighbouring fp32 numbers
at the true t. 0.5 ulp is the best that a correctly rounded fp32 number can do; the dark upright line is 1 ulp. The
upright bar at the mark is where the middle half of the timed runs lay. Errors below 0.1 ulp are drawn at 0.1. The grey
line is the Pareto front: methods on it are beaten by no other in both error and time.</p><p>The shape of the mark tells
whether the method also gave a <b>wrong decision</b> (a miss for a hit, a hit for a miss, another solid):</p>
<ul class="legend">)";
  s += "<li>" + legendMark(0, "#555") + " none</li><li>" + legendMark(1, "#555") +
       " only where changing the input by at most " + number(kNearUlps) +
       " ulp of fp32 could change the true answer</li><li>" + legendMark(2, "#555") +
       " elsewhere too, or t was no number: the error is then unbounded, and the mark stands at &#8734;</li></ul>" +
       methodsKey();
  return s +
         "<p>Point at a mark to see its numbers. Every number is in the table below its plots, and in study.csv "
         "and study.json beside this page.</p></section>";
}

std::string methods(const Study& study) {
  std::string s =
      "<section><h2>The methods, all measurements together</h2><table><thead><tr><th "
      "class=\"words\">method</th><th>rays</th>"
      "<th>wrong, near an edge</th><th>wrong beyond</th><th>t no number</th><th>largest error of t, ulp</th>"
      "<th class=\"words\">what it promises</th></tr></thead><tbody>";
  for (const std::size_t way : study.ways) {
    std::uint64_t rays = 0, near = 0, beyond = 0, notFinite = 0;
    double most = 0;
    for (const Row& row : study.rows) {
      if (row.way != way) continue;
      rays += row.errors.rays, near += row.errors.wrongNear, beyond += row.errors.wrongBeyond;
      notFinite += row.errors.notFinite;
      if (row.errors.agreedHits > 0) most = std::max(most, row.errors.max);
    }
    s += "<tr><th>" + wayName(way) + "</th><td>" + grouped(rays) + "</td><td>" + grouped(near) + "</td><td>" +
         grouped(beyond) + "</td><td>" + grouped(notFinite) + "</td><td>" + number(most) + "</td><td class=\"words\">" +
         promiseOf(kWays[way]) + "</td></tr>";
  }
  return s + "</tbody></table></section>";
}

/// Families by kinds, one small field a method.
std::string failures(const Study& study, Section section, const std::string& title) {
  std::vector<std::string> kinds, families;
  std::map<std::pair<std::string, std::string>, std::map<std::size_t, const Row*>> found;
  const auto keep = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const Row& row : study.rows) {
    if (row.section != section) continue;
    keep(kinds, row.kind), keep(families, row.family);
    found[{row.family, row.kind}][row.way] = &row;
  }
  if (kinds.empty()) return "";
  std::string s = "<h3>" + title + "</h3><table class=\"map\"><thead><tr><th></th>";
  for (const std::string& kind : kinds)
    s += "<th colspan=\"" + std::to_string(study.ways.size()) + "\">" + escaped(kind) + "</th>";
  s += "</tr><tr><th></th>";
  for (std::size_t i = 0; i < kinds.size(); ++i)
    for (const std::size_t way : study.ways)
      s += std::string("<th style=\"color:") + kWays[way].colour + "\">" + kWays[way].letter + "</th>";
  s += "</tr></thead><tbody>";
  for (const std::string& family : families) {
    s += "<tr><th>" + escaped(family) + "</th>";
    for (const std::string& kind : kinds)
      for (const std::size_t way : study.ways) {
        const auto cell = found.find({family, kind});
        s += cell == found.end() || cell->second.count(way) == 0 ? "<td class=\"none\"></td>"
                                                                 : errorField(*cell->second.at(way));
      }
    s += "</tr>";
  }
  return s + "</tbody></table>";
}

std::string failureMaps(const Study& study) {
  const std::string rays = failures(study, Section::rays, "Free rays"),
                    pixels = failures(study, Section::pixels, "Pixels of cameras");
  if (rays.empty() && pixels.empty()) return "";
  return "<section><h2>Where each method fails</h2><p>One field a method, in the order N F E D; the colour is the "
         "largest "
         "error (white: at most 1 ulp; dark: 10<sup>6</sup> ulp and more). &#9651; wrong decisions, but only near an "
         "edge; "
         "&#10005; on red: wrong decisions beyond, or no number. Rows are families of rays: what is difficult about "
         "them.</p>" +
         colourKey() + "<div class=\"wide\">" + rays + "</div><div class=\"wide\">" + pixels + "</div></section>";
}

std::string kindSection(const Study& study, const std::string& kind) {
  std::string s = "<section id=\"" + kind + "\"><h2>" + escaped(kind) + "</h2>";
  std::string plots;
  for (const Sweep& sweep : study.sweeps) {
    if (sweep.kind != kind) continue;
    plots += "<figure>" + difficultyPlot(sweep, rowsOf(study, Section::sweep, kind, sweep.id)) + "<figcaption>" +
             escaped(sweep.note) + "</figcaption></figure>";
  }
  if (!plots.empty())
    s += "<h3>Where each method falls off</h3><p>Each plot makes one difficulty harder from left to right. Above: the "
         "error "
         "that 99 % of the hits stay below (full line) and the largest error (dotted). Below: the share of wrong "
         "decisions.</p>" +
         methodsKey() + "<div class=\"plots\">" + plots + "</div>";
  for (const Section section : {Section::rays, Section::pixels}) {
    const auto all = rowsOf(study, section, kind, "");
    if (all.empty()) continue;
    const Range times = timesOf(all);
    s += section == Section::rays ? "<h3>Error against time: free rays</h3>"
                                  : "<h3>Error against time: pixels of cameras</h3>";
    s += "<div class=\"plots\">";
    for (const std::string& family : familiesIn(all))
      s += "<figure>" + workPrecision(rowsOf(study, section, kind, family), family, times) + "<figcaption>" +
           escaped(familyNote(section, family)) + "</figcaption></figure>";
    s += "</div><details><summary>Numbers</summary>" + table(all) + "</details>";
  }
  return s + "</section>";
}

std::string scenes(const Study& study) {
  std::string s;
  for (const Scene& scene : study.request.scenes) {
    const auto rows = rowsOf(study, Section::scene, "scene", scene.file);
    if (rows.empty()) continue;
    s +=
        "<section><h2>A whole picture: " + escaped(scene.file) + "</h2><p>" +
        std::to_string(scene.world.solids.size()) +
        " solids. The difference pictures show the error of t in each pixel: light where it is small, dark where it is "
        "large, <b class=\"wrong\">red</b> where the wrong solid was hit, or none, or t is no number; grey where "
        "nothing is "
        "to be hit.</p>" +
        colourKey() + "<div class=\"plots\"><figure>" +
        workPrecision(rows, "whole picture, ns per pixel", timesOf(rows)) +
        "<figcaption>Error against time per pixel, all solids of the scene tested.</figcaption></figure>";
    for (const ScenePicture& p : study.pictures)
      if (p.scene == scene.file)
        s += "<figure><img alt=\"" + escaped(p.caption) + "\" src=\"data:image/png;base64," + base64(p.pngFile) +
             "\"/><figcaption>" + (p.way < kWayCount ? "error of " + wayName(p.way) : escaped(p.caption)) +
             "</figcaption></figure>";
    s += "</div>" + table(rows) + "</section>";
  }
  return s;
}

std::string catalogueSection(const Study& study) {
  if (study.cases.empty()) return "";
  std::string s =
      "<section><h2>The catalogue of extreme cases</h2><p>Single rays, pixels and families, each picked for what "
      "it breaks. Fields show the error of t in ulp; &#10005; is a wrong decision, \"miss\" and \"false hit\" say "
      "which "
      "one.</p>";
  std::map<std::size_t, std::array<int, 3>> counts;  // right within 1 ulp; right but further off; wrong
  std::string body;
  for (const CaseNote& c : study.cases) {
    const auto rows = rowsOf(study, Section::catalogue, c.kind, c.id);
    if (rows.empty()) continue;
    body += "<tr><th>" + escaped(c.id) + "</th><td class=\"words\">" + escaped(c.kind) + "</td><td class=\"words\">" +
            escaped(c.note) + "</td><td class=\"way\">" + escaped(c.truth) + "</td>";
    for (const Row* row : rows) {
      const Errors& e = row->errors;
      const bool wrong = e.wrong() > 0 || e.notFinite > 0;
      ++counts[row->way][wrong ? 2 : e.agreedHits > 0 && !(e.max <= 1) ? 1 : 0];
      body += caseField(*row);
    }
    body += "</tr>";
  }
  s += "<table><thead><tr><th class=\"words\">method</th><th>right, within 1 ulp</th><th>right, but further "
       "off</th><th>wrong "
       "decision</th></tr>"
       "</thead><tbody>";
  for (const auto& [way, n] : counts)
    s += "<tr><th>" + wayName(way) + "</th><td>" + std::to_string(n[0]) + "</td><td>" + std::to_string(n[1]) +
         "</td><td>" + std::to_string(n[2]) + "</td></tr>";
  s += "</tbody></table><details open><summary>All cases</summary><table "
       "class=\"cases\"><thead><tr><th class=\"words\">case</th><th class=\"words\">solid</th>"
       "<th class=\"words\">what is extreme</th><th>truth</th>";
  for (const std::size_t way : study.ways) s += "<th>" + wayName(way) + "</th>";
  return s + "</tr></thead><tbody>" + body + "</tbody></table></details></section>";
}

std::string times(const Study& study) {
  return "<section><h2>What the times contain</h2><p>GPU time by timestamps around one dispatch, median of " +
         std::to_string(study.request.runs) +
         " runs; all methods take turns, so that whatever else the machine did hit them alike. Nothing is subtracted. "
         "<b>Free rays</b>: 65,536 rays at one solid; reading the ray (32 bytes) and writing the hit (44 bytes) are in "
         "it; "
         "naive and fast also calculate normal, local coordinates and point, which exact leaves to the host. "
         "<b>Pixels</b>: one solid; making the ray, distance and solid index written; four rays share an invocation. "
         "<b>Whole picture</b>: the same with all solids, per pixel. The host's part of exact (rays in doubt again in "
         "higher precision; for free rays also t, normal and point of every hit) is not in these times: the tables "
         "give it "
         "as <i>host</i>, wall time per ray on all cores.</p></section>";
}

std::string omissions(const Study& study) {
  std::string s = "<section><h2>Omissions</h2><ul>";
  for (const std::string& line : study.omissions) s += "<li>" + escaped(line) + "</li>";
  return s + "</ul></section>";
}

}  // namespace

std::string toHtml(const Study& study) {
  std::vector<std::string> kinds;
  for (const Row& row : study.rows)
    if ((row.section == Section::rays || row.section == Section::pixels || row.section == Section::sweep) &&
        std::find(kinds.begin(), kinds.end(), row.kind) == kinds.end())
      kinds.push_back(row.kind);
  std::string s =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>solidcast study</title><style>" +
      styleSheet() + "</style></head><body>" + head(study);
  if (kinds.size() > 1) {
    s += "<nav>";
    for (const std::string& kind : kinds) s += "<a href=\"#" + kind + "\">" + escaped(kind) + "</a> ";
    s += "</nav>";
  }
  s += howToRead() + methods(study) + failureMaps(study) + scenes(study);
  for (const std::string& kind : kinds) s += kindSection(study, kind);
  return s + catalogueSection(study) + times(study) + omissions(study) + "</body></html>\n";
}

}  // namespace solidcast::study
