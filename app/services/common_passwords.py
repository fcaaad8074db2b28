"""Passwords that everybody tries first, as far as they are long enough to be taken otherwise."""

from __future__ import annotations

LISTED = """
0123456789 01234567890 0987654321 1029384756 1111111111 1122334455 1234512345 123456123456 1234567890 12345678900
12345678910 1234567891 123456789a 123456789q 123456789z 123qweasdzxc 147258369 1q2w3e4r5t 1q2w3e4r5t6y 1qaz2wsx3edc
9876543210 abc123abc123 abcd123456 abcdefghij administrator admin12345 admin123456 asdfghjkl1 asdfghjkl; basketball
changeme123 clearlines clearlines1 correcthorsebatterystaple football123 iloveyou123 letmein123 letmeinnow
michaeljordan mypassword1 p@ssw0rd123 p@ssword123 passw0rd123 password00 password01 password10 password11 password12
password123 password1234 password12345 password123456 password! password1! passwordpassword q1w2e3r4t5 q1w2e3r4t5y6
qazwsxedc123 qwe123qwe123 qwer123456 qwerty12345 qwerty123456 qwerty1234 qwertyuiop qwertyuiop1 qwertyuiop123
secret12345 superman123 unbelievable welcome123 welcome1234 zaq12wsxcde3 zxcvbnm123 zxcvbnm,./
"""

COMMON_PASSWORDS = frozenset(LISTED.split())
"""Compared with the lower-case form."""
