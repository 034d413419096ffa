/* The verbs of analyze: each a filter in a file of its own. argv[0] is
   "analyze", the rest the verb's options and operand; returns the program's
   exit status. */
#ifndef VERBS_H
#define VERBS_H

int verb_fraction(int argc, char **argv);
int verb_profile(int argc, char **argv);
int verb_radius(int argc, char **argv);

#endif
