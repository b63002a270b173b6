// An explanation as text: the conclusion first, then what it rests on.
#include <algorithm>
#include <cstdio>

#include "host/explain/explain.h"
#include "host/explain/words.h"

namespace solidcast::explain {
namespace {

using Cells = std::vector<std::string>;

/// Columns under each other, two blanks between them.
std::string table(const std::vector<Cells>& rows) {
  std::vector<std::size_t> widths;
  for (const Cells& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (widths.size() <= i) widths.push_back(0);
      widths[i] = std::max(widths[i], row[i].size());
    }
  std::string text;
  for (const Cells& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += "  " + row[i];
      if (i + 1 < row.size()) line += std::string(widths[i] - row[i].size(), ' ');
    }
    text += line + '\n';
  }
  return text;
}

std::string number(const char* format, double x) {
  char text[64];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

std::string three(V3 v, std::string (*spelled)(f128)) {
  std::string text = spelled(v.x);
  for (const f128 x : {v.y, v.z}) text.append(" ").append(spelled(x));
  return text;
}

std::string rays(const Explanation& e) {
  std::vector<Cells> rows{{"true origin", three(e.origin, hex), three(e.origin, brief)},
                          {"true direction", three(e.direction, hex), three(e.direction, brief)}};
  if (e.camera == "orthographic" || !e.seen.cameraAxes)
    rows.push_back({"shader's origin", three(e.seen.origin, hex),
                    e.method == "naive" ? "in world axes" : "in world axes, from the camera's centre"});
  rows.push_back({"shader's direction", three(e.seen.direction, hex),
                  std::string(e.seen.cameraAxes ? "in camera axes (right, up, backward)" : "in world axes") +
                      ", off by " + brief(e.seen.directionError) + " of its length"});
  return "ray (fp64 nearest to the true one)\n" + table(rows);
}

std::string decisions(const Explanation& e) {
  std::vector<Cells> rows{{"", "solid", "t", "error", "radiance", "8 bit"}};
  const Verdict* verdicts[] = {&e.gpu, &e.cpu, &e.truth};
  for (std::size_t i = 0; i < 3; ++i) {
    const Verdict& v = *verdicts[i];
    const bool hit = v.index >= 0;
    rows.push_back(
        {v.name, v.solid, hit ? decimal(v.t) : "-",
         i == 2                    ? ""
         : !v.right && v.ulps == 0 ? "wrong"
         : hit                     ? number("%.3g ulp", v.ulps)
                                   : "none",
         number("%.9g", v.radiance[0]) + " " + number("%.9g", v.radiance[1]) + " " + number("%.9g", v.radiance[2]),
         std::to_string(v.levels[0]) + " " + std::to_string(v.levels[1]) + " " + std::to_string(v.levels[2])});
  }
  return "decision\n" + table(rows) + "  truth decided by " + e.decidedBy +
         "; to turn it, the inputs would have to change by " + brief(e.truthMargin) + " x 2^-24 of themselves" +
         (e.tie ? "; another solid has the same t, the earlier wins" : "") + "\n";
}

std::string candidates(const Explanation& e) {
  std::string text = "candidates by t: " + std::to_string(e.candidates.size());
  if (e.further > 0) text += ", " + std::to_string(e.further) + " more left out";
  text += "; missed by far: " + std::to_string(e.clear) + "\n";
  if (e.candidates.empty()) return text;
  std::vector<Cells> rows{
      {"solid", "form", "method", "truth", "t", "true t", "decided by", "value", "bound", "margin"}};
  for (const Candidate& c : e.candidates) {
    const Decision* d = c.trial.decisive();
    Cells row{c.name,
              c.trial.dropped ? "dropped" : c.trial.form,
              c.trial.hit ? "hit" : "miss",
              c.truth.hit ? "hit" : "miss",
              c.trial.hit ? number("%.9g", c.trial.t) : "-",
              c.truth.hit ? decimal(c.truth.t) : "-"};
    if (d != nullptr)
      row.insert(row.end(),
                 {d->name, brief(d->shader), number("%.2g", d->bound),
                  number("%.3g", d->margin) + (d->margin < 1 ? " IN DOUBT" : "") + (d->wrong() ? " WRONG SIGN" : "")});
    else row.push_back("nothing to decide");
    rows.push_back(row);
  }
  return text + table(rows);
}

std::string stages(const Candidate& c) {
  std::string text = "stages of " + c.name;
  if (!c.trial.dropped) text += " by " + c.trial.form + "'s formulas";
  text += ": " + c.lost + "\n";
  if (c.trial.stages.empty()) return text;
  std::vector<Cells> rows{{"stage", "shader", "true", "digits right", "lost here", "most of the error by"}};
  for (const Stage& s : c.trial.stages) {
    const bool vector = s.shader.size() == 3;
    const auto shown = [&](const std::vector<f128>& v) {
      return vector ? brief(v[0]) + " " + brief(v[1]) + " " + brief(v[2]) : number("%.9g", static_cast<double>(v[0]));
    };
    rows.push_back({s.name, shown(s.shader), shown(s.truth), number("%.1f", s.digits),
                    s.lost >= 0.05 ? number("%.1f", s.lost) : "", s.source()});
  }
  return text + table(rows);
}

}  // namespace

std::string asText(const Explanation& e) {
  std::string text = "pixel " + std::to_string(e.x) + "," + std::to_string(e.y) + " of " + std::to_string(e.width) +
                     "x" + std::to_string(e.height) + ", " + e.camera + " camera, method " + e.method + " in " +
                     e.arithmetic + "\n" + e.conclusion + "\n\n";
  text += rays(e) + "\n" + decisions(e) + "\n";
  if (e.method == "exact") {
    text += e.secondPass ? "second pass: the first was in doubt, the host decided in binary128\n"
                         : "second pass: not needed, every decision is clear of its bound\n";
    for (const std::string& doubt : e.doubts) text += "  " + doubt + "\n";
    text += "\n";
  }
  text += candidates(e);
  if (!e.followed)
    text += "\nthe device does not calculate as followed below: its own roundings differ (see solidcast devices)\n";
  for (const Candidate& c : e.candidates)
    if (c.matters) text.append("\n").append(stages(c));
  return text;
}

}  // namespace solidcast::explain
