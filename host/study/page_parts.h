// Tables, fields and the style sheet of the page.
#pragma once
#include "host/study/plot.h"

namespace solidcast::study {

/// The study's rows of a section; "" for any kind or family.
std::vector<const Row*> rowsOf(const Study& study, Section section, const std::string& kind, const std::string& family);
std::vector<std::string> familiesIn(const std::vector<const Row*>& rows);

std::string wayName(std::size_t way);  // in its colour
std::string grouped(std::uint64_t n);  // 1,234,567
std::string base64(const std::string& bytes);

/// What is difficult about a family.
std::string familyNote(Section section, const std::string& family);

std::string table(const std::vector<const Row*>& rows);
/// A field of the map of failures, and of the table of cases.
std::string errorField(const Row& row);
std::string caseField(const Row& row);
/// Legends: colours of methods, colours of errors.
std::string methodsKey();
std::string colourKey();

std::string styleSheet();

}  // namespace solidcast::study
