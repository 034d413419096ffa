/* The verbs of analyze: each a filter in a file of its own. argv[0] is
   "analyze", the rest the verb's options and operand; returns the program's
   exit status. */
#ifndef VERBS_H
#define VERBS_H

int verb_fraction(int argc, char **argv);
int verb_contacts(int argc, char **argv);
int verb_rest(int argc, char **argv);
int verb_gr(int argc, char **argv);
int verb_order(int argc, char **argv);
int verb_export(int argc, char **argv);

#endif
