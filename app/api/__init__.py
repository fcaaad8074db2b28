"""The REST API and the pages: routes parse, call a service and answer; they hold no rules."""
