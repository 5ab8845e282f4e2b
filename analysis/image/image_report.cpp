#include "analysis/image/image_report.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "analysis/report/profile_chart.h"
#include "analysis/report/report_page.h"
#include "analysis/report/report_text.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// None of grains of one size.
std::optional<Picture> passing_chart(const AnalysedPhoto& photo, std::size_t number, const fs::path& folder) {
  const std::vector<ImageGrading>& gradings = photo.gradings;
  const double low = gradings[0].curve->diameter(0), high = gradings[0].curve->diameter(1);
  if (!(high > low)) return std::nullopt;
  std::string blocks, plots;
  for (std::size_t k = gradings.size(); k-- > 0;) {  // the whole region last, on top
    if (!gradings[k].curve) continue;
    blocks += fmt::format("$p{} << END\n", k);
    for (int step = 0; step <= 100; ++step)
      blocks += fmt::format("{:.6g} {}\n", gradings[k].curve->diameter(step / 100.0), step);
    blocks += "END\n";
    const double share =
        gradings.size() > 2 ? static_cast<double>(k - 1) / static_cast<double>(gradings.size() - 2) : 0;
    const std::string look =
        k == 0 ? "lw 2 dt 2 lc rgb '#000000'" : fmt::format("lw 1.5 lc rgb '#{:06x}'", viridis(0.88 * share));
    plots += fmt::format("{}$p{} using 1:2 with lines {} title {}", plots.empty() ? "" : ", ", k, look,
                         gnuplot_quoted(gradings[k].name));
  }
  const fs::path file = folder / fmt::format("passing-{}.svg", number);
  run_gnuplot(
      chart_terminal(760, 400) +
          "set logscale x\nset xlabel 'grain diameter (m)'\nset ylabel 'passing by mass (%)'\nset yrange "
          "[0:100]\nset key outside right Left reverse samplen 2 invert\n" +
          fmt::format("set xrange [{:.6g}:{:.6g}]\nset xtics ({})\n", low, high, log_ticks(low, high)) +
          blocks + "plot " + plots + "\n",
      file);
  return Picture{"Passing curves", file,
                 "Mass of the outlines counted, finer than a diameter; dashed the whole region."};
}

Picture chi_chart(const ImageReport& report, const fs::path& folder) {
  ProfileChart chart{"", "x/L along the slope", "segregation degree χ", true, {}};
  for (std::size_t i = 0; i < report.photos.size(); ++i) {
    const auto series = [&](const std::vector<ImageGrading>& gradings, ChartSeries::Kind kind,
                            const char* what) {
      const std::string& name = report.photos[i].name;
      ChartSeries out{name, kind, static_cast<int>(i), {}, what};
      if (report.photos.size() > 1) out.label = fmt::format("{}, {}", name, what);
      const double n = static_cast<double>(gradings.size()) - 1;
      for (std::size_t k = 1; k < gradings.size(); ++k)
        if (std::isfinite(gradings[k].chi))
          out.points.push_back({(2.0 * static_cast<double>(k) - 1) / (2 * n), gradings[k].chi});
      return out;
    };
    chart.series.push_back(series(report.photos[i].gradings, ChartSeries::Kind::measured, "measured"));
    if (i < report.checks.size())
      chart.series.push_back(series(report.checks[i].known, ChartSeries::Kind::ours, "known rock"));
  }
  draw(chart, folder / "chi.svg");
  return {"Segregation degree", folder / "chi.svg",
          report.checks.empty()
              ? "Above zero a section is coarser than the whole region."
              : "Triangles as measured in the picture, dots and lines the rock that can be seen in it."};
}

Picture bias_chart(const ImageBias& bias, const fs::path& folder) {
  std::string block = "$b << END\n";
  for (const BiasClass& size : bias.classes)
    block += fmt::format("{:.6g} {:.6g} {:.6g}\n", std::sqrt(size.low * size.high),
                         static_cast<double>(size.detected) / size.visible, size.ratio);
  const double low = bias.classes.front().low, high = bias.classes.back().high;
  const auto curve = [](const std::string& share) {
    return share + " with lines lw 1.5 lc rgb '#0072b2' title 'detected, fitted', ";
  };
  const std::string fitted = !bias.limit ? ""
                             : *bias.limit > 0
                                 ? curve(fmt::format("1/(1+({:.6g}/x)**{:.6g})", *bias.limit, bias.steepness))
                                 : curve("1");
  run_gnuplot(
      chart_terminal(760, 400) +
          fmt::format(
              "set logscale x\nset xlabel 'true diameter (m)'\nset xrange [{:.6g}:{:.6g}]\nset xtics "
              "({})\nset ylabel 'share, ratio'\nset yrange [0:1.5]\nset key top left reverse Left\n{}END\n"
              "plot {}$b using 1:2 with points "
              "pt 7 ps 0.6 lc rgb '#0072b2' title 'detected share of visible grains', $b using 1:3 with "
              "points "
              "pt 9 ps 0.9 lc rgb '#d55e00' title 'measured over true diameter'\n",
              low, high, log_ticks(low, high), block, fitted),
      folder / "bias.svg");
  return {"Bias of the analysis", folder / "bias.svg",
          "What became of known grains, by their true diameter."};
}

std::string gradings_table(const std::vector<ImageGrading>& gradings) {
  std::string out =
      "<div class=\"wide\"><table><thead><tr><th class=\"word\">Section</th><th>Grains</th><th>Mass, "
      "t</th><th>D10, "
      "cm</th><th>D30</th><th>D50</th><th>D60</th><th>D80</th><th>D95</th><th>Cu</th><th>Cc</th><th>χ</th></"
      "tr></thead>"
      "<tbody>\n";
  for (const ImageGrading& grading : gradings) {
    out += fmt::format("<tr><td class=\"word\">{}</td><td>{}</td><td>{}</td>", grading.name, grading.grains,
                       number_text(grading.mass / 1000));
    for (const double d : {grading.d10, grading.d30, grading.d50, grading.d60, grading.d80, grading.d95})
      out += fmt::format("<td>{}</td>", number_text(100 * d));
    out += fmt::format("<td>{}</td><td>{}</td><td>{}</td></tr>\n", decimals_text(grading.cu, 2),
                       decimals_text(grading.cc, 2), decimals_text(grading.chi, 2));
  }
  return out + "</tbody></table></div>\n";
}

std::string check_table(const TruthCheck& check, const std::string& bodies) {
  std::string out = "<div class=\"wide\"><table><thead><tr><th class=\"word\">Section</th>";
  for (const char* quantity : {"D10 of visible rock, cm", "D50", "D80"})
    out += fmt::format("<th>{}</th><th>measured</th><th>error</th>", quantity);
  out +=
      "<th>mass seen</th><th>χ of visible "
      "rock</th><th>measured</th><th>difference</th></tr></thead><tbody>\n";
  for (std::size_t k = 0; k < check.known.size(); ++k) {
    const ImageGrading &known = check.known[k], &measured = check.measured[k];
    out += fmt::format("<tr><td class=\"word\">{}</td>", known.name);
    for (const auto& [should, is] : {std::pair(known.d10, measured.d10), std::pair(known.d50, measured.d50),
                                     std::pair(known.d80, measured.d80)})
      out += fmt::format("<td>{}</td><td>{}</td><td>{} %</td>", number_text(100 * should),
                         number_text(100 * is), decimals_text(100 * (is / should - 1), 1));
    out += fmt::format("<td>{} %</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                       decimals_text(100 * measured.mass / known.mass, 0), decimals_text(known.chi, 2),
                       decimals_text(measured.chi, 2), decimals_text(measured.chi - known.chi, 2));
  }
  return out + fmt::format(
                   "</tbody></table></div>\n<p>{} % of the known mass is seen{}. Perfect outlines of what "
                   "can be seen would give D10 {}, D50 {} and D80 {} cm: what lies on rock hides a part of "
                   "it. D50 of all rock of the scene, hidden rock too: {} cm; measured {} % off.</p>\n",
                   decimals_text(100 * check.mass_seen(), 0), bodies, number_text(100 * check.ideal[0].d10),
                   number_text(100 * check.ideal[0].d50), number_text(100 * check.ideal[0].d80),
                   number_text(100 * check.scene_d50),
                   decimals_text(100 * (check.measured[0].d50 / check.scene_d50 - 1), 1));
}

std::string bias_words(const ImageBias& bias) {
  if (!bias.says_something())
    return fmt::format("<p>Of {} outlines {} belong to a known grain: too few to say anything of size.</p>\n",
                       bias.outlines, bias.matched);
  std::string half = detection_in_words(bias);
  half[0] = static_cast<char>(std::toupper(half[0]));
  return fmt::format(
      "<p>Of {} outlines {} belong to a known grain. {}. The ratio of measured to true diameter grows with "
      "size to the power {}; about that, ln d scatters by {}. In this form the effects {}image_blur and "
      "image_shape_bias take it: effects.yaml.</p>\n",
      bias.outlines, bias.matched, half, decimals_text(bias.exponent, 3), decimals_text(bias.width, 3),
      bias.limit ? "detection_limit, " : "");
}

}  // namespace

std::vector<std::string> write_image_report(const ImageReport& report, const fs::path& folder) {
  std::string body;
  PageFigures shown;
  for (std::size_t i = 0; i < report.photos.size(); ++i) {
    const AnalysedPhoto& photo = report.photos[i];
    const PhotoAnalysis& found = photo.found;
    body += fmt::format(
        "<h2>{}</h2>\n<p class=\"lead\">{} grains of {} cm² and more; D50 {} cm, Cu {}, Cc {}. "
        "{} cm a pixel{}; {} smaller outlines, {} cut by the border.</p>\n",
        html_escaped(photo.name), count_text(static_cast<double>(found.grains.size())),
        number_text(1e4 * report.settings.detection_area), number_text(100 * photo.gradings[0].d50),
        decimals_text(photo.gradings[0].cu, 1), decimals_text(photo.gradings[0].cc, 2),
        number_text(100 * found.scale.at(found.region.middle_y())),
        report.settings.m_per_px ? "" : ", from " + counted_text(found.targets.size(), "target"),
        count_text(found.below_limit), count_text(static_cast<double>(found.cut.size())));
    if (!found.notes.empty()) {
      body += "<div class=\"notes\"><ul>";
      for (const std::string& note : found.notes) body += "<li>" + html_escaped(note) + "</li>";
      body += "</ul></div>\n";
    }
    body += shown.figure(Picture{"What was counted", report.overlays[i],
                                 "Outlines of grains, borders of sections, scale targets."});
    body +=
        gradings_table(photo.gradings) + shown.figure([&] { return passing_chart(photo, i + 1, folder); });
    if (i < report.checks.size())
      body += "<h3>Against what is known</h3>\n" +
              check_table(report.checks[i], html_escaped(bodies_in_words(report.settings)));
  }
  body += "<h2>Along the slope</h2>\n" + shown.figure([&] { return chi_chart(report, folder); });
  if (report.bias)
    body +=
        "<h2>Bias against size</h2>\n" + bias_words(*report.bias) +
        (report.bias->classes.empty() ? "" : shown.figure([&] { return bias_chart(*report.bias, folder); }));
  write_text_file(folder / "report.html",
                  html_page("Gradings from photographs",
                            fmt::format("{} · sizes by the model {}, c/b = {:g}", report.version,
                                        name_of(report.settings.model), report.settings.shape_factor),
                            body));
  return shown.missing();
}

}  // namespace scree
