#include <algorithm>

#include <fmt/format.h>

#include "base/shell_quoted.h"
#include "report/figures/study_figures.h"
#include "report/pages/html_text.h"
#include "report/pages/study_pages.h"
#include "study/study_tables.h"

namespace gauntlet {
namespace {

std::string TableOf(const Table& table) {
  return table.empty() ? "" : table.ToHtml();
}

std::string InWords(const StudyClaim& claim) {
  return fmt::format("{}: this {}.", claim.text, claim.holds ? "holds" : "does not hold");
}

std::string PublishedHtml(const std::vector<JudgedRow>& rows, std::string_view title) {
  if (rows.empty()) return "";
  PublishedNotes notes;
  std::string html = fmt::format("<h3>{}</h3>\n{}", Html(title), TableOf(PublishedTable(rows, notes)));
  if (notes.all().empty()) return html;
  html += "<p>Notes:</p><ol>\n";
  for (const std::string& note : notes.all()) html += fmt::format("<li>{}</li>\n", Html(note));
  return html + "</ol>\n";
}

std::string FiguresHtml(const StudyPages& study, const StudySection& section) {
  std::string html;
  for (const NamedFigure& figure : FiguresOf(*study.report, section))
    html += FigureHtml(figure, study.directory);
  return html;
}

// What it comes to first, then the picture, then every number.
std::string AnalysisHtml(const StudyPages& study, const StudySection& section) {
  std::string html = fmt::format("<h2>{}</h2>\n", Html(section.title));
  if (section.claim) html += ParagraphHtml(InWords(*section.claim), "verdict");
  html += FiguresHtml(study, section);
  for (const std::string& sentence : section.sentences) html += ParagraphHtml(sentence);
  for (const Table& table : section.tables) html += TableOf(table);
  return html + PublishedHtml(section.published, "Published figures beside ours");
}

// A tuning's last sentence and last table are what it recommends.
std::string TuningHtml(const StudyPages& study, const StudySection& section) {
  std::string html = fmt::format("<h2>{}</h2>\n", Html(section.title));
  html += ParagraphHtml(section.sentences.back(), "verdict") + TableOf(section.tables.back());
  html += FiguresHtml(study, section) + "<h3>Why</h3>\n";
  for (auto sentence = section.sentences.begin(); sentence + 1 != section.sentences.end(); ++sentence)
    html += ParagraphHtml(*sentence);
  html += "<h3>In numbers</h3>\n";
  for (auto table = section.tables.begin(); table + 1 != section.tables.end(); ++table)
    html += TableOf(*table);
  return html + PublishedHtml(section.published, "Published values beside ours");
}

std::string LinkTo(std::string_view page, std::string_view text) {
  return fmt::format("<p><a href=\"#{}\">{}</a></p>\n", page, Html(text));
}

}  // namespace

std::string StudyOverviewHtml(const StudyPages& study) {
  std::string html = fmt::format("<h2>{}</h2>\n{}{}", Html(study.name),
                                 ParagraphHtml(study.directory, "soft"), ParagraphHtml(study.description));
  if (!study.report) {
    return html +
           ParagraphHtml(
               "It has not finished: what it finds stands here when it has. Where nobody works on it "
               "any more, this goes on:",
               "notes") +
           CommandHtml("gauntlet resume " + PastedPath(study.directory));
  }
  const StudyReport& report = *study.report;
  bool others = false;
  for (const StudySection& section : report.sections) {
    if (section.tuning) {
      html += ParagraphHtml(section.sentences.back(), "verdict") +
              LinkTo("parameters", "What was tried, and how sure that is: " + section.title);
    }
    others = others || !section.tuning;
  }
  html += TableOf(ClaimTable(report)) + ParagraphHtml(TallyInWords(report));
  if (others) html += LinkTo("comparison", "What was compared, with every figure");
  return html + fmt::format("<details><summary>What it has cost</summary>{}{}</details>\n",
                            TableOf(PartTable(report)), ParagraphHtml(TimeInWords(report)));
}

std::string StudyResultsHtml(const StudyPages& study) {
  if (!study.report) return "";
  std::string html;
  for (const StudySection& section : study.report->sections) {
    if (!section.tuning) html += AnalysisHtml(study, section);
  }
  if (html.empty()) return "";
  return html + PublishedHtml(study.report->elsewhere, "Published figures that have no counterpart here");
}

std::string ParametersHtml(const StudyPages& study) {
  if (!study.report) return "";
  std::string html;
  for (const StudySection& section : study.report->sections) {
    if (section.tuning) html += TuningHtml(study, section);
  }
  return html;
}

Result<StudyPages> GatherStudy(const std::string& dir) {
  TRY(const Study study, OpenStudy(dir));
  StudyPages pages{.directory = dir, .name = study.name, .description = study.description, .report = {}};
  for (const StudyStage stage : {StudyStage::kSearches, StudyStage::kEvaluations}) {
    if (std::ranges::count(study.parts, stage, &StageOf) == 0) continue;
    TRY(const StageState state, LookAtStage(study, dir, stage));
    if (!state.finished) return pages;
  }
  TRY(pages.report, MakeStudyReport(study, dir));
  return pages;
}

}  // namespace gauntlet
