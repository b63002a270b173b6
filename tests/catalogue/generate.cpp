// Writes catalogue.json: `generate_catalogue FILE`. Run it after a change of the cases; a test holds the file to it.
#include <fstream>
#include <iostream>

#include "tests/catalogue/cases.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: generate_catalogue FILE\n";
    return 2;
  }
  using namespace solidcast::catalogue;
  Catalogue catalogue = allCases();
  fillTruth(catalogue);
  std::ofstream out(argv[1]);
  out << writeCatalogue(catalogue) << std::flush;
  if (!out) {
    std::cerr << argv[1] << ": cannot be written\n";
    return 5;
  }
  std::cout << catalogue.size() << " cases\n";
}
