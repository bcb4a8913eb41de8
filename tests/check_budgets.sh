#!/bin/sh
# check_budgets.sh: budgets.sh, for `make check`.
exec sh "$(dirname "$0")/budgets.sh"
