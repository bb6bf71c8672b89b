#include "man_page.h"

#include <fmt/format.h>

namespace limn::cli {
namespace {

/// Text that roff takes as it stands: backslashes and hyphens escaped, no line begins with a control character.
std::string roff(std::string_view text) {
  std::string out;
  if (text.starts_with('.') || text.starts_with('\'')) out += "\\&";
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string upper(std::string_view text) {
  std::string out;
  for (const char c : text)
    out += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return out;
}

std::string head(std::string_view page, std::string_view summary) {
  return fmt::format(".TH {} 1 \"\" \"limn {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", upper(page), LIMN_VERSION,
                     roff(page), roff(summary));
}

std::string exit_section() {
  return ".SH EXIT STATUS\n0 done; 2 usage; 3 a file that could not be read or written; 4 a mesh unsuitable for what "
         "was "
         "asked;\n5 a \\-\\-fail\\-if gate failed; 6 no OpenGL; 130 interrupted; 141 standard output was closed.\n";
}

}  // namespace

std::string program_man_page() {
  std::string page = head("limn", "gives coarse triangle meshes the outline of fine ones");
  page += ".SH SYNOPSIS\n.B limn\n.I VERB\n[arguments]\n.SH VERBS\n";
  for (const Verb& verb : verbs()) {
    if (verb.listed)
      page += fmt::format(".TP\n.B {}\n{}; see \\fBlimn\\-{}\\fR(1)\n", roff(verb.name), roff(verb.summary),
                          roff(verb.name));
  }
  return page + exit_section();
}

std::string verb_man_page(const Verb& verb) {
  OptionTable table;
  CommonOptions common;
  bool help = false;
  declare(verb, table, common, help);
  std::string page = head(fmt::format("limn-{}", verb.name), verb.summary);
  page += fmt::format(".SH SYNOPSIS\n.B limn {}\n{}\n.SH OPTIONS\n", roff(verb.name), roff(verb.usage));
  for (const Option& option : table.options())
    page += fmt::format(".TP\n.B {}\n{}\n", roff(option.spelled()), roff(option.what));
  page += ".SH EXAMPLES\n";
  for (const Example& example : verb.examples) {
    page += fmt::format("{}:\n.PP\n.nf\n.RS\n{}\n.RE\n.fi\n.PP\n", roff(example.what), roff(example.command));
  }
  return page + exit_section() + ".SH SEE ALSO\n\\fBlimn\\fR(1)\n";
}

}  // namespace limn::cli
