/* stored.c: look-up of kept tables.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "stored.h"
#include <string.h>

const stf_stored *stf_stored_find(const char *family, int s)
{
  for (size_t i = 0; family && i < stf_stored_count; i++)
    if (stf_stored_tables[i].s == s && !strcmp(stf_stored_tables[i].family, family))
      return stf_stored_tables + i;
  return NULL;
}

void stf_stored_transform(const stf_stored *kept, stf_transform *transform)
{
  const int s = kept->s;
  *transform = (stf_transform){
    .s = s, .shifts = (s + 1) / 2, .B = kept->B, .T = kept->T, .Tinv = kept->Tinv};
  for (int k = 0; k < transform->shifts; k++) {
    transform->re[k] = kept->re[k], transform->im[k] = kept->im[k];
    transform->row[k] = s % 2 ? (k ? 2 * k - 1 : 0) : 2 * k;
  }
}
