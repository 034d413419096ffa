/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Debian's liblammps-dev comes without the fmt that its headers want. These
   names are declared for them; nothing of ours uses them. */
#ifndef FMT_FORMAT_H
#define FMT_FORMAT_H

#include <string>

namespace fmt {
inline namespace v7_lmp {
struct string_view {
  const char *text;
  size_t length;
  string_view(const char *s) : string_view(std::string(s)) {}
  string_view(const std::string &s) : text(s.data()), length(s.size()) {}
};
struct format_args {
  const void *at;
  long kind;
};
template <class... Args, class Text>
format_args make_args_checked(const Text &, const Args &...);
template <class Text, class... Args>
std::string format(const Text &, Args &&...);
} // namespace v7_lmp
} // namespace fmt

#endif
